"""The folder of the settings."""

from pathlib import Path


def conf_folder() -> Path:
    """The folder conf/ of the clone."""
    return Path(__file__).parents[2] / "conf"
