"""Gaussian-weighted averages over the surface, the basis of centre-surround detectors."""

from dataclasses import dataclass

import numpy as np

from stages.kit import Mesh

from ..kernels import gaussian_sums

SPACING = 0.01  # of the diagonal: the longest edge of an element; the elements' centres lie about half as far apart
CELLS = 3  # per sigma: elements that share a cell count as one, at their centre; widens the Gaussian by under 1 %


@dataclass(frozen=True)
class SurfaceElements:
    """Small triangles that make up a surface: centres (s, 3), areas (s,) and values there (s, d)."""

    centres: np.ndarray
    areas: np.ndarray
    values: np.ndarray


def surface_elements(mesh: Mesh, values: np.ndarray) -> SurfaceElements:
    """The SurfaceElements of a mesh, with values (n, d) interpolated from the vertices."""
    corners = subdivide(mesh, values)
    areas = np.linalg.norm(np.cross(*_sides(corners)), axis=1) / 2
    centres = corners.mean(axis=1)
    return SurfaceElements(centres[:, :3], areas, centres[:, 3:])


def subdivide(mesh: Mesh, values: np.ndarray) -> np.ndarray:
    """(s, 3, 3 + d) corners of the faces, bisected until no edge is longer than SPACING, with the values (n, d)."""
    corners = np.concatenate([mesh.vertices, values], axis=1)[mesh.faces[mesh.face_areas > 0]]
    small = [corners[:0]]
    while len(corners):
        lengths = np.linalg.norm(np.roll(corners, -1, axis=1)[..., :3] - corners[..., :3], axis=2)
        fine = lengths.max(axis=1) <= SPACING * mesh.diagonal
        small.append(corners[fine])
        corners = _halves(corners[~fine], lengths[~fine].argmax(axis=1))
    return np.concatenate(small)


def gaussian_average(mesh: Mesh, elements: SurfaceElements, sigma: float) -> np.ndarray:
    """(n, d) averages over the surface around each vertex, weighted by exp(-distance^2 / (2 sigma^2)) within 2 sigma.

    Distances are Euclidean and sigma is in units of the mesh (Lee, Varshney, Jacobs, Mesh saliency, SIGGRAPH 2005,
    section 3.2). The paper sums over the vertices; an integral over the surface is the same on an even mesh, and on
    an uneven or coarse one it does not follow the tessellation. NaN at a vertex with no surface within 2 sigma.
    """
    near = _merged(elements, sigma / CELLS)
    values = near.areas[:, None] * np.column_stack([np.ones(len(near.areas)), near.values])
    totals = gaussian_sums(mesh.vertices, near.centres, values, sigma)
    return np.divide(totals[:, 1:], totals[:, :1], out=np.full_like(totals[:, 1:], np.nan), where=totals[:, :1] > 0)


def _sides(corners):
    """Two edges (s, 3) of each element."""
    return corners[:, 1, :3] - corners[:, 0, :3], corners[:, 2, :3] - corners[:, 0, :3]


def _halves(corners, longest):
    """Faces (m, 3, k) bisected at the middle of their longest edge, which runs from corner `longest` to the next."""
    turned = np.take_along_axis(corners, ((longest[:, None] + np.arange(3)) % 3)[..., None], axis=1)
    a, b, c = turned.transpose(1, 0, 2)
    middle = (a + b) / 2
    return np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])


def _merged(elements, size):
    """The elements that share a cell of a grid of the given size as one, at their common centre."""
    columns = np.ascontiguousarray(np.concatenate([elements.centres, elements.values], axis=1).T)
    x, y, z = (np.floor((column - column.min(initial=np.inf)) / size).astype(np.int64) for column in columns[:3])
    cell = np.unique((x * (y.max(initial=0) + 1) + y) * (z.max(initial=0) + 1) + z, return_inverse=True)[1]
    areas = np.bincount(cell, elements.areas)
    means = np.stack([np.bincount(cell, elements.areas * column) / areas for column in columns], axis=1)
    return SurfaceElements(means[:, :3], areas, means[:, 3:])
