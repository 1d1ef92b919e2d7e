"""Files whose surface comes in pieces, one a material, doubled at texture seams: OBJ with materials, and GLB."""

import numpy as np
import trimesh

from stages.kit import Mesh
from stages.kit.texture import Texture


def joined(loaded, order=None):
    """One Mesh of a loaded Trimesh or Scene: vertices at one place with one colour are one, textures stay a corner's.

    order: (n, 3) vertices of the file, whose numbers the vertices then take; None numbers them by first appearance.
    Returns None where there are no faces.
    """
    parts = loaded.dump() if isinstance(loaded, trimesh.Scene) else [loaded]
    parts = [part for part in parts if isinstance(part, trimesh.Trimesh) and len(part.faces)]
    if not parts:
        return None
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    faces = np.concatenate([part.faces + start for part, start in zip(parts, starts, strict=False)])
    vertices, colors = np.concatenate([part.vertices for part in parts]), None
    if all(part.visual.kind == "vertex" for part in parts):
        colors = np.concatenate([part.visual.vertex_colors[:, :3] for part in parts])
    texture = _texture(parts)
    if order is not None and colors is None:
        first, ids = merged(np.concatenate([order, vertices]))
        if first.max() < len(order):
            return Mesh(order, first[ids[len(order) :]][faces], None, texture)
    first, ids = merged(vertices if colors is None else np.column_stack([vertices, colors]))
    return Mesh(vertices[first], ids[faces], None if colors is None else colors[first], texture)


def vertices_of(content):
    """(n, 3) the `v` lines of an OBJ file's bytes, in their order."""
    lines = (line.split() for line in content.splitlines())
    return np.array([line[1:4] for line in lines if line[:1] == [b"v"]]).astype(np.float64).reshape(-1, 3)


def merged(rows):
    """(first (k,), ids (n,)): bit-equal rows (n, d) become one, numbered in the order of first appearance."""
    _, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[inverse.ravel()]


def _texture(parts):
    """The Texture of all parts, or None where there is neither a picture nor a second plain colour."""
    images = [_image(part) for part in parts]
    plain = {one.tobytes() for one in images if one.shape[:2] == (1, 1)}
    if all(part.visual.kind != "texture" for part in parts):
        return None
    if len(plain) <= 1 and all(one.shape[:2] == (1, 1) for one in images):
        return None
    uv = [_corners(part) for part in parts]
    sizes = [len(part.faces) for part in parts]
    names = {}
    numbers = [names.setdefault((one.shape, one.tobytes()), len(names)) for one in images]
    distinct = [images[numbers.index(number)] for number in range(len(names))]
    return Texture(np.concatenate(uv), np.repeat(numbers, sizes), tuple(distinct))


def _image(part):
    """The picture of a part's material, (h, w, 4) u1; one pixel where it has only a colour."""
    material = getattr(part.visual, "material", None)
    picture = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
    if picture is not None and getattr(part.visual, "uv", None) is not None:
        return np.asarray(picture.convert("RGBA"))
    color = getattr(material, "main_color", None)
    return np.asarray([204, 204, 204, 255] if color is None else color, dtype=np.uint8).reshape(1, 1, 4)


def _corners(part):
    """(m, 3, 2) texture coordinates of a part's face corners."""
    uv = getattr(part.visual, "uv", None)
    if uv is None or len(uv) != len(part.vertices):
        return np.zeros((len(part.faces), 3, 2))
    return np.nan_to_num(np.asarray(uv, dtype=np.float64)[:, :2])[part.faces]
