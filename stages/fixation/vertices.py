"""The projection of image maps to the vertices of the mesh (T3.3.5)."""

import numpy as np
from scipy.ndimage import map_coordinates

from stages.kit import Mesh, Viewpoint
from stages.kit.camera import project


def project_to_vertices(pictures: np.ndarray, mesh: Mesh, viewpoint: Viewpoint, seen: np.ndarray) -> np.ndarray:
    """(t, n) f8: maps (t, h, w) of one view at its visible vertices, seen (n,) boolean; zero at the others.

    The thesis draws the projected vertices and maps the bounding box of the object in the image onto theirs. But a
    Grad-CAM map shows no object with a bounding box, and boxes of pixels are a pixel off. Here the camera gives the
    position of each vertex in the image to a fraction of a pixel, and rays (stages.conspicuity.facing) decide which
    vertices are visible. Interpolates bilinearly between pixels.
    """
    pictures, seen = np.asarray(pictures, dtype=np.float64), np.asarray(seen, dtype=bool)
    if pictures.ndim != 3 or seen.shape != (len(mesh.vertices),):
        raise ValueError(f"pictures (t, h, w) and seen ({len(mesh.vertices)},), got {pictures.shape} and {seen.shape}")
    found = np.zeros((len(pictures), len(seen)))
    rows, columns, _ = project(mesh.vertices[seen], viewpoint, pictures.shape[1:])
    for values, picture in zip(found, pictures, strict=True):
        values[seen] = map_coordinates(picture, [rows, columns], order=1, mode="nearest")
    return found


def mean_over_views(values: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """(t, n): the mean of values (v, t, n) over the views that see each vertex, seen (v, n) boolean; 0 without any."""
    seen = np.asarray(seen, dtype=np.float64)
    views = seen.sum(axis=0)
    summed = np.einsum("vtn,vn->tn", values, seen)
    return np.divide(summed, views, out=np.zeros_like(summed), where=views > 0)
