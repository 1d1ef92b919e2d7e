"""Several levels of detail of one mesh: how they are written on a command line, and the names of their files."""

import argparse
from pathlib import Path

from .export import FORMATS
from .targets import face_count


def levels(text: str) -> list[str]:
    """["50%", "25%"] of the text `50%,25%`; argparse.ArgumentTypeError for what is no face count."""
    try:
        found = [part.strip() for part in text.split(",")]
        for part in found:
            face_count(part, 1, "--levels")
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return list(dict.fromkeys(found))


def level_path(folder: Path, name: str, source: Path, target: str, kind: str | None = None) -> Path:
    """folder/NAME_50pct.glb; kind: such as glb; None for that of the source where it can be written, or else glb."""
    own = source.suffix.lower()
    suffix = f".{kind}" if kind else own if own in FORMATS else ".glb"
    return folder / f"{name}_{target.replace('%', 'pct')}{suffix}"
