"""Where the settings lie that ship with the code."""

from pathlib import Path


def conf_folder() -> Path:
    """The folder conf/: inside `stages` where a wheel is installed, beside it in a checkout."""
    stages = Path(__file__).parents[1]
    installed = stages / "conf"
    return installed if installed.is_dir() else stages.parent / "conf"
