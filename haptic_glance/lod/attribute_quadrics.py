"""Attributes in the error of a simplification (colours, texture coordinates, normals), and their values after it."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy import sparse

from haptic_glance.mesh.materials import without_corner_pictures
from haptic_glance.mesh.mesh import Mesh, unit

from .attributes import SAME
from .kernels.mesh import HalfEdgeMesh, fans
from .kernels.quadrics import Wedges

Attributes = tuple[tuple[str, float], ...]  # (name, weight) of those that the error counts

NAMES = ("colors", "normals", "uv")
ROWS, COLUMNS = [0, 0, 0, 1, 1, 2, 0, 1, 2, 3], [0, 1, 2, 1, 2, 2, 3, 3, 3, 3]  # of a quadric: A, b, c
SLIVER = 1e-6  # height over length of a face, below which its gradient is rounding


def check_attributes(mesh: Mesh, weights: Mapping[str, float] | None) -> Attributes:
    """(name, weight) of the attributes that count, by name; raises ValueError for what is no weight of this mesh's."""
    attributes, is_absent = dict(weights or {}), {"colors": mesh.colors is None, "uv": mesh.texture is None}
    for name, weight in attributes.items():
        if name not in NAMES:
            raise ValueError(f"unknown attribute {name!r}: choose from {', '.join(NAMES)}")
        if not 0 <= weight < np.inf:
            raise ValueError(f"the weight of {name} must be 0 or more, got {weight}")
        if weight and is_absent.get(name):
            painted = name == "colors" and mesh.texture is not None  # as faces of one colour each are, once repaired
            remedy = "weigh those of its texture by uv" if painted else "leave out their weight"
            raise ValueError(f"the mesh has no {name}{' of vertices' if painted else ''}: {remedy}")
    return tuple(sorted((name, float(weight)) for name, weight in attributes.items() if weight))


def attribute_quadrics(
    mesh: Mesh, attributes: Attributes, position: np.ndarray, corner: np.ndarray,
    opposite: np.ndarray, factor: np.ndarray,
) -> tuple[np.ndarray, Wedges]:  # fmt: skip
    """((n, 10) to add to the quadrics of the vertices, the Wedges of the surface).

    attributes: as of `check_attributes`. position (n, 3), corner (3 m,), opposite (3 m,): the half-edge mesh, whose
    half-edges are the corners of the mesh's faces in their order. factor (n,): of each vertex's quadric.

    A weight of w counts an attribute that is off by one (a colour from black to white, the width of the picture, a
    normal of unit length) as a displacement by w times the longest side of the mesh's bounding box. A seam of the
    texture counts as an edge over which it is off by one: pulled sideways, it shows the wrong picture.
    """
    weights = dict(attributes)
    if "uv" in weights and mesh.texture is not None:
        mesh = replace(mesh, texture=without_corner_pictures(mesh.texture))
    points = position[corner].reshape(-1, 3, 3)
    seam = _seams(mesh, opposite) if "uv" in weights else np.zeros(len(corner), dtype=bool)
    wedge = fans(corner, np.where(seam, np.int32(-1), opposite))[0]
    predicted, area = _predictions(points, _values(mesh, weights))
    area = np.repeat(area / 3, 3) * factor[corner]
    squares = np.einsum("fka,fkb->fab", predicted, predicted)[:, ROWS, COLUMNS]
    quadric = _summed(corner, len(position), area, squares)
    quadric += _seam_quadrics(points, corner, seam, weights.get("uv", 0.0), factor)
    count = int(wedge.max()) + 1
    means = _summed(wedge, count + 1, area, predicted.reshape(len(predicted), -1))
    sums = np.column_stack([np.bincount(wedge, area, count + 1), means])
    scratch = np.zeros((2, 10)), np.zeros((2, 3))
    return quadric, Wedges(wedge, np.arange(count + 1, dtype=np.int32), _rings(wedge, corner), sums, *scratch)


def _seams(mesh, opposite):
    """(3 m,) boolean: half-edges across which the texture coordinates or the images differ."""
    uv, image = mesh.texture.uv.reshape(-1, 2), np.repeat(mesh.texture.image, 3)
    next_uv = np.roll(mesh.texture.uv, -1, axis=1).reshape(-1, 2)
    end = np.arange(len(uv)).reshape(-1, 3)
    head = np.roll(end, -1, axis=1).ravel()[opposite]
    jump = np.maximum(np.abs(uv - uv[head]), np.abs(next_uv - uv[opposite])).max(axis=1)
    return (opposite >= 0) & ((jump > SAME) | (image != image[opposite]))


def _values(mesh, weights):
    """(m, 3, k): the attributes at the corners of the faces, times their weights."""
    columns = []
    if "colors" in weights:
        columns += [weights["colors"] / 255 * mesh.colors[mesh.faces].astype(np.float64)]
    if "normals" in weights:
        columns += [weights["normals"] * mesh.vertex_normals[mesh.faces]]
    if "uv" in weights:
        columns += [weights["uv"] * mesh.texture.uv]
    return np.concatenate(columns, axis=2)


def _predictions(points, values):
    """(gradient and constant (m, k, 4) of each attribute, area (m,)) of the faces; no gradient on slivers."""
    first, second = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    normal = np.cross(first, second)
    square = (normal**2).sum(axis=1)
    length = np.maximum((first**2).sum(axis=1), (second**2).sum(axis=1))
    good = square > (SLIVER * length) ** 2
    with np.errstate(all="ignore"):
        axes = np.stack([np.cross(second, normal), np.cross(normal, first)], axis=1) / square[:, None, None]
    axes[~good] = 0
    gradient = np.einsum("fak,fac->fkc", values[:, 1:] - values[:, :1], axes)
    constant = values[:, 0] - np.einsum("fkc,fc->fk", gradient, points[:, 0])
    return np.concatenate([gradient, constant[..., None]], axis=2), np.sqrt(square) / 2


def _summed(owner, count, area, rows):
    """(count, c): rows (m, c) of the faces, times the area (3 m,) of each corner, summed by its owner (3 m,)."""
    face = np.arange(len(owner)) // 3
    return sparse.csr_matrix((area, (owner, face)), shape=(count, len(rows))) @ rows


def _seam_quadrics(points, corner, seam, weight, factor):
    """(n, 10): the squared distances to the planes through the edges of the seams, upright on their faces."""
    edges = np.flatnonzero(seam)
    tail, head = points.reshape(-1, 3)[edges], np.roll(points, -1, axis=1).reshape(-1, 3)[edges]
    a, b, c = points[edges // 3].transpose(1, 0, 2)
    across = unit(np.cross(head - tail, np.cross(b - a, c - a)))
    plane = np.column_stack([across, -np.einsum("ij,ij->i", across, tail)])
    rows = weight**2 / 2 * plane[:, ROWS] * plane[:, COLUMNS]
    ends = np.concatenate([corner[edges], np.roll(corner.reshape(-1, 3), -1, axis=1).ravel()[edges]])
    rows = np.concatenate([rows, rows]) * factor[ends, None]
    return np.stack([np.bincount(ends, column, len(factor)) for column in rows.T], axis=1)


def _rings(wedge, corner):
    """(w + 1,) i4: the next wedge of the same vertex, in a ring."""
    count = int(wedge.max()) + 1
    owner = np.empty(count, dtype=np.int64)
    owner[wedge] = corner
    order = np.argsort(owner, kind="stable")
    starts = np.flatnonzero(np.r_[True, np.diff(owner[order]) > 0])
    following = np.arange(count + 1, dtype=np.int32)
    following[order[:-1]] = order[1:]
    following[order[np.r_[starts[1:], count] - 1]] = order[starts]
    return following


JUMP = 10.0  # variance of an attribute's gradient around a vertex (1 over the mesh's longest side, squared) at a jump


def at_jumps(surface: HalfEdgeMesh, wedges: Wedges) -> np.ndarray:
    """(n,) boolean: vertices which the fit to the surface would pull off a line where an attribute jumps.

    On a ball with a painted band, 2,000 of 81,920 faces, they keep the colour error at 0.34 of 255, which is 1.24 with
    the fit of all vertices; the Metro mean stays within 1 %.
    """
    owner, sums = _live(surface, wedges)
    area = np.maximum(sums[:, 0], np.finfo(float).tiny)
    of_mean = sum((sums[:, n : n + 3] ** 2).sum(axis=1) for n in range(1, sums.shape[1], 4)) / area
    size = len(surface.position)
    total = surface.quadric[:, 0] + surface.quadric[:, 3] + surface.quadric[:, 5]
    area = np.bincount(owner, area, size)
    return total - np.bincount(owner, of_mean, size) > (1 + JUMP) * area


def merged_colors(surface: HalfEdgeMesh, wedges: Wedges, weight: float) -> np.ndarray:
    """(n, 3) u1: the colours of least error at the vertices, where colours are the first attribute, of this weight."""
    owner, sums = _live(surface, wedges)
    sums = np.stack([np.bincount(owner, column, len(surface.position)) for column in sums[:, :13].T], axis=1)
    sums[:, 0] = np.maximum(sums[:, 0], np.finfo(float).tiny)
    predicted = sums[:, 1:].reshape(-1, 3, 4)
    values = np.einsum("nkc,nc->nk", predicted[..., :3], surface.position) + predicted[..., 3]
    return np.clip(np.rint(255 / weight * values / sums[:, :1]), 0, 255).astype(np.uint8)


def _live(surface, wedges):
    """(vertex, sums) of the wedges that still have faces."""
    root = wedges.merged
    while (root[root] != root).any():
        root = root[root]
    owner = np.full(len(root), -1, dtype=np.int64)
    live = surface.corner >= 0
    owner[root[wedges.wedge[live]]] = surface.corner[live]
    return owner[owner >= 0], wedges.sums[owner >= 0]
