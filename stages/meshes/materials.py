"""Joins meshes that a file splits by material and duplicates at texture seams: OBJ with materials, and GLB.

A material counts by its colour or its picture of colour: Kd and map_Kd, baseColorFactor and baseColorTexture.
"""

from typing import Any

import numpy as np
import trimesh
from PIL import Image
from trimesh.visual import ColorVisuals, TextureVisuals
from trimesh.visual.color import to_rgba
from trimesh.visual.material import color_image

from stages.kit import Mesh
from stages.kit.texture import Texture

MADE_UP: Any = color_image()  # what trimesh paints a material with whose file is not there


def join_parts(
    loaded: trimesh.parent.Geometry, order: np.ndarray | None = None, every_colour: bool = False
) -> Mesh | None:
    """One Mesh of a loaded Trimesh or Scene; vertices with equal position and colour are merged. None without faces.

    Texture coordinates stay per face corner. order: (n, 3) vertices in the order of the file, whose ids the merged
    vertices take; None numbers them by first appearance. every_colour: the texture has the colours per vertex, too, of
    parts that stand beside others with materials, or that have a plain material.
    """
    parts = loaded.dump() if isinstance(loaded, trimesh.Scene) else [loaded]
    parts = [part for part in parts if isinstance(part, trimesh.Trimesh) and len(part.faces)]
    if not parts:
        return None
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    faces = np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=False)])
    vertices = np.concatenate([part.vertices for part in parts])
    colored = [part_colors for part in parts if (part_colors := vertex_colors(part)) is not None]
    colors = np.concatenate(colored) if len(colored) == len(parts) else None
    if every_colour and colors is None:
        parts = [_as_picture(part) for part in parts]
    texture = texture_of(parts)
    if order is not None and colors is None:
        first, ids = merge_equal_rows(np.concatenate([order, vertices]))
        if first.max() < len(order):
            return Mesh(order, first[ids[len(order) :]][faces], None, texture)
    first, ids = merge_equal_rows(vertices if colors is None else np.column_stack([vertices, colors]))
    return Mesh(vertices[first], ids[faces], None if colors is None else colors[first], texture)


def vertex_colors(part: trimesh.Trimesh, of_faces: bool = False) -> np.ndarray | None:
    """(n, 3) u1, or None when the colours are not per vertex. of_faces: else the mean of the faces around a vertex."""
    visual = part.visual
    kinds = ("vertex", "face") if of_faces else ("vertex",)
    return visual.vertex_colors[:, :3] if isinstance(visual, ColorVisuals) and visual.kind in kinds else None


def _as_picture(part):
    """The part; its colours per vertex become a picture of one row, where it has no other picture."""
    colors, beside = vertex_colors(part), part.vertex_attributes.get("color")
    if colors is None and beside is not None and _image(part).size == 4:  # an OBJ with colours and a plain material
        colors = to_rgba(beside)[:, :3]
    if colors is None:
        return part
    uv = np.column_stack([(np.arange(len(colors)) + 0.5) / len(colors), np.full(len(colors), 0.5)])
    visual = TextureVisuals(uv, image=Image.fromarray(np.ascontiguousarray(colors)[None]))
    return trimesh.Trimesh(part.vertices, part.faces, visual=visual, process=False)


def obj_vertices(content: bytes) -> np.ndarray:
    """(n, 3) f8: the vertices of an OBJ file's bytes, in the order of the `v` lines."""
    lines = (line.split() for line in content.splitlines())
    return np.array([line[1:4] for line in lines if line[:1] == [b"v"]]).astype(np.float64).reshape(-1, 3)


def merge_equal_rows(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Merges bit-equal rows (n, d) in the order of first appearance: first (k,) and ids (n,)."""
    _, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[inverse.ravel()]


def texture_of(parts: list[trimesh.Trimesh]) -> Texture | None:
    """The Texture of all parts, one behind the other, or None when no material states a colour or a picture."""
    if not any(_stated(part) for part in parts):
        return None
    images = [_image(part) for part in parts]
    uv = [_corners(part) for part in parts]
    sizes = [len(part.faces) for part in parts]
    names = {}
    numbers = [names.setdefault((one.shape, one.tobytes()), len(names)) for one in images]
    distinct = [images[numbers.index(number)] for number in range(len(names))]
    return Texture(np.concatenate(uv), np.repeat(numbers, sizes), tuple(distinct))


def _stated(part):
    """Whether the file states a colour or a picture for the part; where it does not, trimesh makes one up."""
    material = getattr(part.visual, "material", None)
    if any(getattr(material, name, None) is not None for name in ("baseColorTexture", "baseColorFactor")):
        return True
    image = getattr(material, "image", None)
    made_up = image is None or np.array_equal(image.convert("RGBA"), MADE_UP)
    return not made_up or "kd" in getattr(material, "kwargs", {})


def _image(part):
    """The image of a part's material, (h, w, 4) u1; one pixel for a plain colour."""
    material = getattr(part.visual, "material", None) if _stated(part) else None
    image = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
    if image is not None and getattr(part.visual, "uv", None) is not None:
        return np.asarray(image.convert("RGBA"))
    color = getattr(material, "main_color", None)
    return np.asarray([204, 204, 204, 255] if color is None else color, dtype=np.uint8).reshape(1, 1, 4)


def _corners(part):
    """(m, 3, 2) texture coordinates of a part's face corners."""
    uv = getattr(part.visual, "uv", None)
    if uv is None or len(uv) != len(part.vertices):
        return np.zeros((len(part.faces), 3, 2))
    return np.nan_to_num(np.asarray(uv, dtype=np.float64)[:, :2])[part.faces]
