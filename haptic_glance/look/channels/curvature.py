"""Curvature, computed on the mesh and projected to the view."""

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.mesh.mesh import Mesh, edge_pairs, unit

from ..views import View
from .surface import surface_conspicuity, visible_surface

SMOOTHING = 0.01  # of the diagonal: smaller bumps are noise or tessellation, and people do not see them either
CAP = 0.98  # of the area: the sharpest 2 % get the same value, or one corner would dominate the map


def curvature(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The curvature conspicuity map (h / 16, w / 16) f4 in 0..1 (T3.1.1) of a view of a mesh.

    The thesis filters the image of the curvature "to simulate the center-surround mechanism" and gives no formula. This
    is the on-centre cell that its text describes, which the surround inhibits: with |c - s|, as for intensity, a flat
    region next to a sharp one is as conspicuous as the sharp one. On the meshes with human gaze, Curv has an NSS of
    0.39 with on-centre cells and of 0.11 with |c - s|. For VisAttAll the values are 0.38 and 0.30. Symmetry, whose map
    is a thin line on black, uses |c - s|: an NSS of 0.12 against 0.05.
    """
    surface = visible_surface(view, mesh)
    values = np.einsum("ij,ij->i", surface.weights, capped_curvature(mesh)[mesh.faces[surface.faces]])
    return surface_conspicuity(values, mesh, view, filled, on_centre=True)


@weak_cache
def capped_curvature(mesh: Mesh) -> np.ndarray:
    """(n,) f8 in 0..1: |mean curvature| over its area-weighted quantile CAP, clipped at 1; zero on a flat mesh."""
    values = np.abs(mean_curvature(mesh))
    areas = np.bincount(mesh.faces.ravel(), weights=np.repeat(mesh.face_areas, 3), minlength=len(values))
    order = np.argsort(values, kind="stable")
    passed = np.cumsum(areas[order])
    top = values[order[np.searchsorted(passed, CAP * passed[-1])]] if len(passed) and passed[-1] > 0 else 0
    flat = 1e-6 / max(mesh.diagonal, np.finfo(float).tiny)
    return np.minimum(values / top, 1) if top > flat else np.zeros(len(values))


def mean_curvature(mesh: Mesh, smoothing: float = SMOOTHING) -> np.ndarray:
    """(n,) f8 mean curvature at the vertices, in 1 / unit: 1 / r on a sphere, 1 / (2 r) on a cylinder, convex positive.

    The curvature of an edge is half its length times the angle between its two faces (the normal cycle: Cohen-Steiner
    and Morvan, Restricted Delaunay triangulations and normal cycle, SoCG 2003); each end gets half of it. Curvature and
    area are then both smoothed by one implicit step of heat flow, over the share `smoothing` of the diagonal, and
    divided. So slivers, which have hardly any area, do not produce outliers, and noise of either sign cancels. Boundary
    edges, edges of more than two faces and edges of two inconsistently wound faces count as flat. Vertices at the same
    position are merged.
    """
    places, welded = np.unique(mesh.vertices, axis=0, return_inverse=True)
    welded = welded.ravel()
    faces, normals = welded[mesh.faces], mesh.face_normals
    tail, head, first, second = _hinges(faces, len(places))
    direction = unit(places[head] - places[tail])
    sine = np.einsum("ij,ij->i", np.cross(normals[first], normals[second]), direction)
    cosine = np.einsum("ij,ij->i", normals[first], normals[second])
    length = np.linalg.norm(places[head] - places[tail], axis=1)
    edge_curvature = length * np.arctan2(sine, cosine) / 4
    edge_curvature[(normals[first] == 0).all(axis=1) | (normals[second] == 0).all(axis=1)] = 0
    integrated = np.bincount(tail, edge_curvature, len(places)) + np.bincount(head, edge_curvature, len(places))
    area = np.bincount(faces.ravel(), np.repeat(mesh.face_areas / 3, 3), len(places))
    return _curvature_density(places, faces, integrated, area, (smoothing * mesh.diagonal) ** 2)[welded]


def _hinges(faces, count):
    """(tail, head, first, second): edges of exactly two faces; `first` runs from tail to head, `second` back."""
    tail, head = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    a, b = edge_pairs(faces, count)
    opposed = (tail[a] == head[b]) & (tail[a] != head[a])
    a, b = a[opposed], b[opposed]
    return tail[a], head[a], a // 3, b // 3


def _curvature_density(places, faces, integrated, area, time):
    """integrated / area after heat flow of both for `time` (length squared), (n,); zero at a position without area."""
    n, corners = len(places), places[faces]
    rows, columns, values = [], [], []
    for k in range(3):
        u, v = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        sine = np.linalg.norm(np.cross(u, v), axis=1)
        # Between 0 and 10: the cotangents of slivers must neither be negative nor connect their ends too strongly.
        cotangent = np.divide(np.einsum("ij,ij->i", u, v), sine, out=np.zeros(len(u)), where=sine > 0).clip(0, 10)
        rows.append(faces[:, (k + 1) % 3])
        columns.append(faces[:, (k + 2) % 3])
        values.append(cotangent / 2)
    rows, columns, values = np.concatenate(rows), np.concatenate(columns), np.concatenate(values)
    weights = sparse.coo_matrix((np.r_[values, values], (np.r_[rows, columns], np.r_[columns, rows])), shape=(n, n))
    laplacian = sparse.diags(np.asarray(weights.sum(axis=1)).ravel()) - weights.tocsr()
    mass = np.maximum(area, 1e-12 * max(area.max(initial=0), 1e-300))
    system = (sparse.diags(mass) + time * laplacian).tocsc()
    flow = splu(system, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    return np.where(area > 0, flow.solve(integrated), 0)
