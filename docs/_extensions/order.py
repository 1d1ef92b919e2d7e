"""The order in which the galleries show their scripts."""

from pathlib import Path

FIRST = (  # tutorials, and the example that a section begins with; the others follow by name
    "own_scans", "own_method", "robot", "touch_environment", "scene_to_gltf", "thesis_table",
    "saliency", "methods", "soft", "hard", "press", "newtons", "budget",
)  # fmt: skip


class ReadingOrder:
    """A sort key of file names, as sphinx-gallery asks for; it is made with the folder."""

    def __init__(self, src_dir: str) -> None:
        pass

    def __call__(self, filename: str | Path) -> tuple[int, str]:
        """(place in FIRST, or behind it; name)."""
        stem = Path(filename).stem
        return FIRST.index(stem) if stem in FIRST else len(FIRST), stem
