"""COLLADA files (.dae), the meshes of many robot descriptions, read by trimesh with pycollada."""

from __future__ import annotations

import io
import re
from contextlib import suppress
from typing import Any
from xml.etree import ElementTree

import numpy as np

from haptic_glance.base.extras import from_extra
from haptic_glance.base.lazy import trimesh

from .headers import MeshError
from .materials import join_parts
from .mesh import Mesh
from .obj import SiblingFiles
from .polygons import refined

UP = re.compile(rb"<(?:\w+:)?up_axis>\s*([XYZ])_UP\s*<")
NAN = re.compile(rb"(?i)<(?:\w+:)?float_array[^>]*>[^<]*\bnan\b")
OTHER_PARTS = {
    "lines": rb"<(?:\w+:)?line(?:s|strips)[\s>]",
    "polygons with holes": rb"<(?:\w+:)?ph[\s>]",
    "skins": rb"<(?:\w+:)?instance_controller[\s>]",
}
PICTURE = re.compile(rb"<(?:\w+:)?init_from>\s*(?:file://)?([^<]*?)\s*<")


def parser_bytes(content: bytes) -> bytes:
    """The bytes in UTF-8; a concave polygon begins at another corner, or becomes triangles.

    pycollada would cut it as a fan about its first corner.
    """
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        text = content.decode("utf-16")
        content = re.sub(r"(<\?xml[^>]*encoding=)[\"'][^\"']*[\"']", r'\1"utf-8"', text, count=1).encode()
    if not re.search(rb"<(?:\w+:)?poly(?:list|gons)[\s>]", content):
        return content
    root = ElementTree.fromstring(content)
    space = root.tag.rpartition("}")[0]
    space += "}" * bool(space)
    changed = False
    for mesh in root.iter(f"{space}mesh"):
        with suppress(ValueError, LookupError, AttributeError, TypeError, StopIteration):  # which the parser names
            numbers = {source.get("id"): source.findtext(f"{space}float_array") for source in mesh}
            positions = {f"#{part.get('id')}": _input(part, "POSITION") for part in mesh.iter(f"{space}vertices")}
            for polygons in mesh.findall(f"{space}polygons"):
                _list(polygons, space)
            for polygons in mesh.iter(f"{space}polylist"):
                corner = _input(polygons, "VERTEX")
                points = str(numbers[positions[corner.get("source")].get("source")[1:]])
                changed |= _unfold(polygons, space, int(corner.get("offset")), points)
    return ElementTree.tostring(root) if changed else content


def _input(element: ElementTree.Element, semantic: str) -> Any:
    return next(part for part in element if part.get("semantic") == semantic)


def _list(polygons: Any, space: str) -> None:
    """Turns `polygons`, which have an element `p` for each, into the equal `polylist`, but for polygons with holes."""
    parts = polygons.findall(f"{space}p")
    if not parts:
        return
    width = 1 + max(int(part.get("offset")) for part in polygons.findall(f"{space}input"))
    corners = [part.text.split() for part in parts]
    for part in parts:
        polygons.remove(part)
    sizes = ElementTree.SubElement(polygons, f"{space}vcount")
    sizes.text = " ".join(str(len(indices) // width) for indices in corners)
    ElementTree.SubElement(polygons, f"{space}p").text = " ".join(index for indices in corners for index in indices)
    polygons.tag = f"{space}polylist"


def _unfold(polygons: Any, space: str, column: int, points: str) -> bool:
    """Whether a list of polygons had concave ones, which are mended. column: of the vertices among the indices."""
    counts, indices = polygons.find(f"{space}vcount"), polygons.find(f"{space}p")
    sizes = np.array(counts.text.split()).astype(np.int64)
    rows = np.array(indices.text.split()).astype(np.int64).reshape(sizes.sum(), -1)
    mended = refined(rows[:, column], sizes, np.array(points.split()).astype(np.float64).reshape(-1, 3))
    if not mended:
        return False
    starts = np.cumsum(sizes) - sizes
    whole = ([range(size)] for size in sizes)
    rings = [np.asarray(ring) + starts[k] for k, same in enumerate(whole) for ring in mended.get(k, same)]
    counts.text = " ".join(str(len(ring)) for ring in rings)
    indices.text = " ".join(map(str, rows[np.concatenate(rings)].ravel().tolist()))
    polygons.set("count", str(len(rings)))
    return True


def read_collada(content: bytes, resolver: trimesh.resolvers.Resolver | None) -> Mesh | None:
    """The Mesh of all triangles and polygons of a scene at their places; None without any.

    Colours count as sRGB, as programs write them. Raises MeshError without a scene, for a scene of skins alone, and for
    NaN, which pycollada would read as 0.
    """
    with from_extra("pycollada, which reads .dae, "):
        import collada  # noqa: F401
    if b"instance_visual_scene" not in content:
        raise MeshError("the file holds no scene")
    if NAN.search(content):
        raise MeshError("some numbers are NaN")
    beside: Any = SiblingFiles(resolver) if resolver else None  # has what a resolver is asked for
    scene = trimesh.load_scene(io.BytesIO(content), file_type="dae", resolver=beside)
    if not scene.geometry and left_out(content)["skins"]:
        raise MeshError("has skins alone, which are not read: export it in its rest pose")
    return join_parts(scene, every_colour=True)


def up_of(content: bytes) -> str:
    """The axis that points up; y where a file does not say, as COLLADA 1.4 has it."""
    match = UP.search(content)
    return match[1].decode().lower() if match else "y"


def left_out(content: bytes) -> dict[str, int]:
    """{kind: count} of the parts of a file that the mesh does not get."""
    return {kind: len(re.findall(form, content)) for kind, form in OTHER_PARTS.items()}


def names_in(content: bytes) -> list[str]:
    """The names of the pictures that a file refers to."""
    return [name.decode(errors="replace") for name in PICTURE.findall(content)]
