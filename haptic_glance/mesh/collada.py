"""COLLADA files (.dae), the meshes of many robot descriptions, read by trimesh with pycollada."""

from __future__ import annotations

import io
import re
from typing import Any

from haptic_glance.base.extras import from_extra
from haptic_glance.base.lazy import trimesh

from .headers import MeshError
from .materials import join_parts
from .mesh import Mesh
from .obj import Beside

UP = re.compile(rb"<(?:\w+:)?up_axis>\s*([XYZ])_UP\s*<")
NAN = re.compile(rb"(?i)<(?:\w+:)?float_array[^>]*>[^<]*\bnan\b")
OTHER_PARTS = {"lines": rb"<(?:\w+:)?line(?:s|strips)[\s>]", "skins": rb"<(?:\w+:)?instance_controller[\s>]"}
PICTURE = re.compile(rb"<(?:\w+:)?init_from>\s*(?:file://)?([^<]*?)\s*<")


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
    beside: Any = Beside(resolver) if resolver else None  # has what a resolver is asked for
    scene = trimesh.load_scene(io.BytesIO(content), file_type="dae", resolver=beside)
    if not scene.geometry and b"<instance_controller" in content:
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
