"""The files that a mesh file names: its materials, their pictures, a depth image."""

import re
from collections.abc import Callable
from pathlib import Path

from trimesh.resolvers import FilePathResolver

NAMES = {  # what names a file, by the suffix of the file in which it stands
    ".obj": re.compile(rb"^[ \t]*mtllib[ \t]+(.+?)\s*$", re.M),
    ".mtl": re.compile(rb"^[ \t]*map_Kd[ \t]+(.+?)\s*$", re.M | re.I),
    ".depth": re.compile(rb'"image"\s*:\s*"([^"]+)"'),
    ".ply": re.compile(rb"^comment[ \t]+TextureFile[ \t]+(.+?)\s*$", re.M | re.I),
}


def files_beside(path: Path) -> dict[str, bytes]:
    """{name: bytes} of the files that a mesh file names, as it spells them: an OBJ and its materials, a PLY, a .depth.

    A file that is not there, or not below the folder of the mesh, is empty.
    """
    return files_named(path.read_bytes(), path.suffix, FilePathResolver(str(path)).get)


def files_named(content: bytes, suffix: str, read: Callable[[str], bytes]) -> dict[str, bytes]:
    """As `files_beside`, of the bytes of a mesh file; read(name, relative to it) raises OSError or ValueError."""
    found: dict[str, bytes] = {}
    wanted = _named(content, suffix)
    while wanted:
        name = wanted.pop(0)
        try:
            found[name] = read(name.replace("\\", "/"))
        except (OSError, ValueError):
            found[name] = b""
        wanted += [other for other in _named(found[name], Path(name).suffix) if other not in found]
    return found


def _named(content, suffix):
    header = content.partition(b"end_header")[0] if suffix.lower() == ".ply" else content
    pattern = NAMES.get(suffix.lower())
    return [name.decode("utf-8", "replace") for name in pattern.findall(header)] if pattern else []
