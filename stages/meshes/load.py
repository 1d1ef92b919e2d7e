"""Reads one mesh file into arrays: STL, OBJ, PLY, OFF and GLB, by trimesh."""

import io
import struct
from pathlib import Path

import numpy as np
import trimesh
from trimesh.resolvers import FilePathResolver, Resolver

from stages.kit import Mesh

from .materials import join_parts, merge_equal_rows, obj_vertices, vertex_colors

FORMATS = (".stl", ".obj", ".ply", ".off", ".glb")


class MeshError(ValueError):
    """A mesh that cannot be used. The message is the reason, without the name of the file."""


def load(path: str | Path) -> Mesh:
    """Reads a mesh file: Mesh(vertices (n, 3) f8, faces (m, 3) i8, colors (n, 3) u1 or None), in the units of the file.

    Vertices keep the order of the file, since ground truth refers to them by index. STL and GLB repeat vertices at
    face corners: equal ones are merged in the order of first appearance. Polygons are triangulated. The parts of a GLB
    scene are transformed and joined. The materials of a GLB, and those of an OBJ whose material files lie next to it,
    become the texture of the mesh. Raises MeshError with the reason when the file holds no usable mesh.
    """
    path = Path(path)
    if not path.is_file():
        raise MeshError(f"no such file: {path}")
    return parse(path.read_bytes(), path.suffix.lower(), FilePathResolver(str(path)))


def parse(content: bytes, suffix: str, resolver: Resolver | None = None) -> Mesh:
    """As `load`, from the bytes of a file and its suffix (`.stl`, ...). Without a resolver, no other file is read."""
    if suffix not in FORMATS:
        raise MeshError(f"cannot read {suffix or 'a file without suffix'}: the formats are {', '.join(FORMATS)}")
    if not content:
        raise MeshError("the file is empty")
    _refuse_truncated(content, suffix)
    try:
        if suffix == ".glb" or (suffix == ".obj" and b"usemtl" in content):
            loaded = join_parts(_open(content, suffix, resolver), obj_vertices(content) if suffix == ".obj" else None)
        else:
            loaded = _open(content, suffix, resolver, maintain_order=True, skip_materials=True)
            if isinstance(loaded, trimesh.Scene):
                loaded = loaded.to_geometry() if loaded.geometry else None
    except MemoryError:
        raise MeshError("its header claims more data than fits in memory") from None
    except Exception as error:  # the parsers raise many types; each means that the file is unreadable
        raise MeshError(f"unreadable as {suffix[1:].upper()} ({type(error).__name__}: {_brief(error)})") from None
    return loaded if isinstance(loaded, Mesh) else _to_mesh(loaded, merge=suffix == ".stl")


def _open(content, suffix, resolver, **options):
    return trimesh.load(io.BytesIO(content), file_type=suffix[1:], resolver=resolver, process=False, **options)


def _to_mesh(loaded, merge):
    if loaded is None:
        raise MeshError("the file holds no geometry")
    if isinstance(loaded, trimesh.PointCloud):
        raise MeshError(f"a point cloud, or truncated before its faces: {len(loaded.vertices)} points, no faces")
    if not isinstance(loaded, trimesh.Trimesh):
        raise MeshError(f"not a triangle mesh but a {type(loaded).__name__}")
    vertices, faces = np.asarray(loaded.vertices, dtype=np.float64), np.asarray(loaded.faces, dtype=np.int64)
    if len(faces) == 0:
        raise MeshError(f"no faces ({len(vertices)} vertices)")
    bad = int((~np.isfinite(vertices).all(axis=1)).sum())
    if bad:
        raise MeshError(f"{bad} of {len(vertices)} vertices have NaN or infinite coordinates")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise MeshError(f"faces name vertices that do not exist (0..{len(vertices) - 1})")
    colors = vertex_colors(loaded)
    if merge:
        first, ids = merge_equal_rows(vertices)
        vertices, faces, colors = vertices[first], ids[faces], None
    return Mesh(vertices, faces, colors)


def _refuse_truncated(content, suffix):
    """MeshError for a file shorter than its header states: the parsers accept it, or their message is unclear."""
    if suffix == ".glb":
        if content[:4] != b"glTF" or len(content) < 12:
            raise MeshError("unreadable as GLB (no glTF header)")
        length = struct.unpack("<I", content[8:12])[0]
        if length > len(content):
            raise MeshError(f"truncated: {len(content)} of {length} bytes")
    elif suffix == ".stl" and (content.lstrip()[:5].lower() != b"solid" or b"facet" not in content):
        if len(content) < 84:
            raise MeshError(f"truncated: {len(content)} bytes are fewer than an STL header")
        count = struct.unpack("<I", content[80:84])[0]
        if 84 + 50 * count > len(content):
            raise MeshError(
                f"truncated or not an STL: the header states {count} faces, {(len(content) - 84) // 50} follow"
            )
    elif suffix == ".off":
        lines = [line for line in content.decode("latin-1").splitlines() if line.split("#")[0].strip()]
        words = " ".join(lines[:2]).split()
        counts = [int(word) for word in words[1:3] if word.isdigit()]
        body = len(lines) - (1 if lines and len(lines[0].split()) > 2 else 2)
        if len(counts) == 2 and body < sum(counts):
            raise MeshError(f"truncated: the header states {sum(counts)} vertices and faces, {body} lines follow")
    elif suffix == ".stl" and b"facet" in content and b"endsolid" not in content:
        raise MeshError("truncated: an ASCII STL without endsolid")


def _brief(error):
    lines = str(error).strip().splitlines()
    return lines[0][:120] if lines else "no details"
