"""Differences between pictures of one object: where a detector puts more points than others, and faces lie dense."""

from collections.abc import Mapping

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.mesh.mesh import Mesh

TINTS = "PuOr_r"  # purple: fewer, orange: more
SPREAD = 0.05  # of the diagonal: deviation of the Gaussian about a point
TOP = 0.98  # quantile of all differences that has the deepest colour
OCTAVES = 3.0  # eight times as many faces an area as the mean, or an eighth, have the deepest colours


def density(mesh: Mesh, points: np.ndarray) -> np.ndarray:
    """(n,) share of the points (k,) vertex ids that lie about each vertex: 1 in the mean; 0 without points."""
    width = SPREAD * mesh.diagonal
    places = KDTree(mesh.vertices[points].reshape(-1, 3))
    near = places.sparse_distance_matrix(KDTree(mesh.vertices), 4 * width, output_type="coo_matrix")
    found = np.bincount(near.col, np.exp(-0.5 * (near.data / width) ** 2), len(mesh.vertices))
    return found / (found.mean() or 1.0)


def against_the_mean(mesh: Mesh, points: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """{method: (n,) in 0..1}: more points about a vertex than the methods have in the mean is over 0.5."""
    found = {method: density(mesh, own) for method, own in points.items() if len(own)}
    mean = np.mean(list(found.values()), axis=0)
    top = float(np.quantile(np.abs(list(found.values()) - mean), TOP)) or 1.0
    return {method: np.clip(0.5 + 0.5 * (own - mean) / top, 0, 1) for method, own in found.items()}


def faces_an_area(mesh: Mesh) -> np.ndarray:
    """(n,) in 0..1: how dense the faces about a vertex lie, over 0.5 where denser than in the mean."""
    smaller = np.log2(mesh.face_areas.mean() / np.maximum(mesh.face_areas, 1e-12))
    corners = mesh.faces.ravel()
    count = np.maximum(np.bincount(corners, minlength=len(mesh.vertices)), 1)
    octaves = np.bincount(corners, np.repeat(smaller, 3), len(mesh.vertices)) / count
    return np.clip(0.5 + 0.5 * octaves / OCTAVES, 0, 1)
