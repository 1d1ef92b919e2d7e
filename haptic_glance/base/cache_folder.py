"""The folder of what is fetched or compiled once on a machine."""

import os
from pathlib import Path


def cache_folder() -> Path:
    """HAPTIC_GLANCE_CACHE, or haptic-glance below the user's cache folder."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(os.environ.get("HAPTIC_GLANCE_CACHE") or Path(base) / "haptic-glance")
