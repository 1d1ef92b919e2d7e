"""The mesh of the whole project as arrays, and its texture.

A texture has coordinates per face corner, so that a seam splits the picture and not the surface.
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse

from .axes import axis_named
from .srgb import decoded, multiplied

CANCELLED = 1e-9  # length of the sum of normals over the sum of their lengths, below which rounding gives the direction
MOST_UV = float(np.finfo(np.float32).max)  # of a texture coordinate, as files hold it


@dataclass(frozen=True, eq=False)
class Texture:
    """The paint of a mesh of m faces; a material of one plain colour is an image of one pixel.

    uv (m, 3, 2) f8, a pair per face corner: u to the right, v up, (0, 0) the lower left corner of the image, which
    repeats outside 0..1. image (m,) i8: which of the images a face shows. images: arrays (h, w, 4) u1, RGBA. All are
    the texture's own, as those of a Mesh are.
    materials: for each image what glTF says of it besides (haptic_glance.mesh.materials.beside_colour), or None.
    """

    uv: np.ndarray
    image: np.ndarray
    images: tuple[np.ndarray, ...]
    materials: tuple[Mapping[str, Any] | None, ...] = ()

    def __post_init__(self) -> None:
        uv, image = _copied(self.uv, np.float64), whole("image", self.image, np.int64)
        images = tuple(whole("images", picture, np.uint8) for picture in self.images)
        for picture in images:
            picture.flags.writeable = False  # so that no further Texture of them copies them again
        if uv.ndim != 3 or uv.shape[1:] != (3, 2):
            raise ValueError(f"uv must be of shape (m, 3, 2), got {uv.shape}")
        if not (np.abs(uv) <= MOST_UV).all():  # NaN fails as well
            raise ValueError(f"uv must be finite, and at most {MOST_UV:.3g}")
        if image.shape != uv.shape[:1]:
            raise ValueError(f"image must have shape {uv.shape[:1]}, got {image.shape}")
        if len(image) and not 0 <= image.min() <= image.max() < len(images):
            raise ValueError(f"image names pictures outside 0..{len(images) - 1}")
        if any(picture.ndim != 3 or picture.shape[2] != 4 or picture.size == 0 for picture in images):
            raise ValueError(f"images must have shape (h, w, 4), got {[picture.shape for picture in images]}")
        materials = tuple(self.materials) or (None,) * len(images)
        if len(materials) != len(images):
            raise ValueError(f"materials must be one for each of {len(images)} images, got {len(materials)}")
        for name, value in (("uv", uv), ("image", image), ("images", images), ("materials", materials)):
            object.__setattr__(self, name, value)

    def of(self, faces: np.ndarray) -> "Texture":
        """The Texture of some faces: ids or (m,) boolean."""
        return replace(self, uv=self.uv[faces], image=self.image[faces])

    def turned(self, flips: np.ndarray) -> "Texture":
        """The Texture after the order of the corners was reversed in the faces (m,) boolean."""
        uv = self.uv.copy()
        uv[flips] = uv[flips][:, ::-1]
        return replace(self, uv=uv)

    def sample(self, faces: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """(k, 3) u1 RGB at texture coordinates uv (k, 2) on the images of faces (k,), nearest pixel.

        A picture's colours are multiplied by the `baseColorFactor` beside it, as glTF defines: without the encoding.
        """
        rgb = np.empty((len(faces), 3), dtype=np.uint8)
        numbers = self.image[faces]
        for number in np.unique(numbers):
            mask, (h, w) = numbers == number, self.images[number].shape[:2]
            across, up = (np.floor(uv[mask] * (w, h)) % (w, h)).astype(np.int64).T  # of any size, before the cast
            pixels = self.images[number][h - 1 - up, across, :3]
            rgb[mask] = multiplied(pixels, colour_factor(self.materials[number]))
        return rgb


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """A triangle mesh; vertex order is identity, nothing is ever reordered behind the caller's back.

    Parameters
    ----------
    vertices : (n, 3) array of float
        Coordinates.
    faces : (m, 3) array of int
        Vertex ids of each triangle, counter-clockwise seen from outside.
    colors : (n, 3) array of uint8, optional
        Colours of the vertices.
    texture : Texture, optional
        Pictures and texture coordinates of the m faces.
    up : str
        The axis that points up, in the form of `axis_named`: y, -z or a vector, and `auto` where the axis is unknown.

    Notes
    -----
    The arrays are copies of the caller's. Do not edit them in place, since derived values are cached: make a new Mesh
    (`dataclasses.replace`), which keeps the axis. Two meshes are equal if all of these fields are equal, and equal
    meshes have one hash. A pickled mesh does not include the derived values.

    Examples
    --------
    >>> from haptic_glance import Mesh
    >>> Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).faces.shape
    (1, 3)
    """

    vertices: np.ndarray
    faces: np.ndarray
    colors: np.ndarray | None = None
    texture: Texture | None = None
    up: str = "z"

    def __post_init__(self) -> None:
        for name in ("faces", "colors"):
            values = getattr(self, name)
            if values is not None and np.size(values) and np.asarray(values).dtype.kind not in "iu":
                raise ValueError(f"{name} must be whole numbers, got {np.asarray(values).dtype}")
        vertices, faces = _copied(self.vertices, np.float64), _copied(self.faces, np.int64)
        if vertices.ndim != 2 or vertices.shape[1] != 3:
            raise ValueError(f"vertices must have shape (n, 3), got {vertices.shape}")
        if faces.ndim != 2 or faces.shape[1] != 3:
            raise ValueError(f"faces must have shape (m, 3), got {faces.shape}")
        if not np.isfinite(vertices).all():
            raise ValueError("vertices hold NaN or infinite coordinates")
        if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
            raise ValueError(f"faces name vertices outside 0..{len(vertices) - 1}")
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)
        if self.colors is not None:
            raw = np.asarray(self.colors)
            if raw.dtype != np.uint8 and raw.size and not 0 <= raw.min() <= raw.max() <= 255:
                raise ValueError(f"colors must lie in 0..255, got {raw.min()} to {raw.max()}")
            colors = _copied(self.colors, np.uint8)
            if colors.shape != vertices.shape:
                raise ValueError(f"colors must have shape {vertices.shape}, got {colors.shape}")
            object.__setattr__(self, "colors", colors)
        if self.texture is not None and len(self.texture.image) != len(faces):
            raise ValueError(f"the texture must be of {len(faces)} faces, got {len(self.texture.image)}")
        object.__setattr__(self, "up", axis_named(self.up))

    def __repr__(self) -> str:
        return f"Mesh({len(self.vertices):,} vertices, {len(self.faces):,} faces, {self.up} up)"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Mesh):
            return NotImplemented
        return self is other or (self.up == other.up and self._arrays() == other._arrays())

    def __hash__(self) -> int:
        return self._hash

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @cached_property
    def _hash(self) -> int:
        return hash((self.up, *(hash(content) for content in self._arrays())))

    def _arrays(self) -> list[bytes]:
        """The content of all arrays, each with its shape."""
        texture = () if self.texture is None else (self.texture.image, self.texture.uv, *self.texture.images)
        arrays = (self.vertices, self.faces, *(() if self.colors is None else (self.colors,)), *texture)
        contents = [
            repr((array.shape, array.dtype.str)).encode() + array.tobytes() for array in map(np.asarray, arrays)
        ]
        materials = () if self.texture is None else self.texture.materials
        return contents + [content for material in materials for content in content_of(material)]

    @cached_property
    def face_crosses(self) -> np.ndarray:
        """(m, 3) cross products of two edges: normal times twice the area."""
        a, b, c = self.vertices[self.faces].transpose(1, 0, 2)
        return np.cross(b - a, c - a)

    @cached_property
    def face_areas(self) -> np.ndarray:
        """(m,) areas, in square units of the mesh."""
        return np.linalg.norm(self.face_crosses, axis=1) / 2

    @cached_property
    def face_normals(self) -> np.ndarray:
        """(m, 3) unit normals; zero where the face has no area."""
        return unit(self.face_crosses)

    @cached_property
    def vertex_normals(self) -> np.ndarray:
        """(n, 3) unit normals, area-weighted over the faces around; zero in no face and where the faces cancel out."""
        sums = corner_sum(self, np.repeat(self.face_crosses[:, None], 3, axis=1))
        sums[np.linalg.norm(sums, axis=1) <= 6 * CANCELLED * self.vertex_areas] = 0
        return unit(sums)

    @cached_property
    def vertex_areas(self) -> np.ndarray:
        """(n,) a third of the area of the faces around each vertex; zero at a vertex in no face."""
        return corner_sum(self, np.repeat(self.face_areas[:, None] / 3, 3, axis=1))

    @cached_property
    def adjacency(self) -> sparse.csr_matrix:
        """(n, n) sparse boolean matrix: True where an edge joins two vertices."""
        tail = self.faces.ravel()
        head = np.roll(self.faces, -1, axis=1).ravel()
        n = len(self.vertices)
        entries = np.ones(2 * len(tail), dtype=bool)
        return sparse.csr_matrix((entries, (np.r_[tail, head], np.r_[head, tail])), shape=(n, n))

    @cached_property
    def edge_counts(self) -> tuple[np.ndarray, np.ndarray]:
        """(edges (e, 2) i8 with the lower id first, counts (e,)): how many faces share each edge."""
        edges = np.sort(np.stack([self.faces, np.roll(self.faces, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
        return np.unique(edges, axis=0, return_counts=True)

    @property
    def watertight(self) -> bool:
        """True when every edge is shared by exactly two faces."""
        return len(self.faces) > 0 and bool((self.edge_counts[1] == 2).all())

    @cached_property
    def used(self) -> np.ndarray:
        """(k,) i8 ids of the vertices that lie in a face, in order."""
        in_a_face = np.zeros(len(self.vertices), dtype=bool)
        in_a_face[self.faces.ravel()] = True
        return np.flatnonzero(in_a_face)

    @cached_property
    def diagonal(self) -> float:
        """Length of the bounding-box diagonal; vertices in no face do not count, but on a mesh without faces."""
        vertices = self.vertices[self.used] if len(self.faces) else self.vertices
        columns = np.ascontiguousarray(vertices.T)  # its extents take an eighth of the time of those of rows
        return float(np.linalg.norm(np.ptp(columns, axis=1))) if len(vertices) else 0.0

    def rings(self, vertices: np.ndarray, count: int) -> np.ndarray:
        """(n,) boolean: the given vertices and all within `count` edges of them."""
        near = np.zeros(len(self.vertices), dtype=bool)
        near[np.asarray(vertices, dtype=np.int64)] = True
        for _ in range(count):
            near |= self.adjacency @ near
        return near


def content_of(material: Mapping[str, Any] | None) -> list[bytes]:
    """The content of one of a Texture's materials: names and values in turn."""
    parts = [part for pair in sorted((material or {}).items()) for part in pair]
    return [part if isinstance(part, bytes) else getattr(part, "tobytes", repr(part).encode)() for part in parts]


def _copied(values: Any, kind: type) -> np.ndarray:
    """A contiguous, writable copy of the values in a type.

    The copy of a read-only array is writable, too: numba would compile all kernels again for read-only arrays.
    """
    return np.array(values, dtype=kind, order="C")


def colour_factor(material):
    """(3,) linear, of a picture's colours; a plain colour, without a picture, is in the image already.

    Bytes of a factor are sRGB, as trimesh gets them from us, and floats linear, as a glTF has them.
    """
    if not material or "baseColorTexture" not in material or material.get("baseColorFactor") is None:
        return np.ones(3)
    factor = np.asarray(material["baseColorFactor"])
    return decoded(factor[:3] / 255) if factor.dtype.kind in "iu" else factor[:3]


def _frozen(values: Any) -> bool:
    """Whether nobody can write to an array, be it through the array that it is a view of."""
    while isinstance(values, np.ndarray) and not values.flags.writeable:
        values = values.base
    return values is None or isinstance(values, bytes)


def whole(name: str, values: Any, kind: type) -> np.ndarray:
    """Copies whole numbers as `_copied` does, and shares an array that nobody can write to.

    Raises ValueError for numbers that the type does not hold.
    """
    array, limits = np.asarray(values), np.iinfo(kind)
    in_range = array.dtype == kind or not array.size or limits.min <= array.min() <= array.max() <= limits.max
    if not in_range or (array.dtype != kind and (array % 1 != 0).any()):
        raise ValueError(f"{name} must be whole numbers of {limits.dtype}, got {array.dtype} of others")
    shared = array.dtype == kind and array.flags.c_contiguous and _frozen(values)
    return array if shared else _copied(values, kind)


def unit(vectors: np.ndarray) -> np.ndarray:
    """Vectors of length one along the last axis; a zero vector stays zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors, dtype=np.float64), where=length > 0)


def bounding_box(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner (3,) of the box around the faces of a mesh."""
    corners = mesh.vertices[mesh.used]
    return corners.min(axis=0), corners.max(axis=0)


def edge_pairs(faces: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """(first (e,), second (e,)): the two half-edges of each edge that exactly two faces (m, 3) share, edge by edge.

    Half-edge 3 * face + k runs from corner k of its face to the next one. count: the number of vertices.
    """
    tails, heads = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    key = np.minimum(tails, heads) * count + np.maximum(tails, heads)
    order = np.argsort(key, kind="stable")
    starts = np.flatnonzero(np.diff(key[order], prepend=-1))
    pairs = starts[np.diff(starts, append=len(order)) == 2]
    return order[pairs], order[pairs + 1]


def next_half_edge(half_edges: np.ndarray) -> np.ndarray:
    """The next half-edge of the face, of each of the half-edges, which are numbered as in `edge_pairs`."""
    return np.where(half_edges % 3 == 2, half_edges - 2, half_edges + 1)


def corner_sum(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """Sums values (m, 3) or (m, 3, d), one per face corner, onto the vertices: (n,) or (n, d)."""
    n = len(mesh.vertices)
    ids = mesh.faces.ravel()
    flat = values.reshape(len(ids), int(np.prod(values.shape[2:])))
    summed = np.stack([np.bincount(ids, weights=column, minlength=n) for column in flat.T], axis=1)
    return summed[:, 0] if values.ndim == 2 else summed
