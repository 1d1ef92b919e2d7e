"""The mesh files that a person names on a command line: one file, or all of a folder."""

from pathlib import Path

from .headers import MeshError
from .load import FORMATS


def mesh_files(place: Path) -> list[Path]:
    """The file itself, or the files of a folder that `load` reads by their suffix, in alphabetical order.

    Folders in the folder are left out. Raises MeshError for a folder without a mesh, and where there is nothing.
    """
    if not place.exists():
        raise MeshError(f"{place}: no such file or folder")
    if not place.is_dir():
        return [place]
    found = sorted(path for path in place.iterdir() if path.suffix.lower() in FORMATS and path.is_file())
    if not found:
        raise MeshError(f"{place}: no mesh in this folder; the formats are {', '.join(FORMATS)}")
    return found


def names_of(files: list[Path]) -> list[str]:
    """A name per file: its own without the suffix, or with it where two files differ in that alone."""
    stems = [path.stem for path in files]
    return [path.stem if stems.count(path.stem) == 1 else path.name for path in files]
