"""From maps of views to the vertices of the mesh (T3.3.5)."""

import numpy as np
from scipy.ndimage import map_coordinates

from stages.kit.camera import project


def on_vertices(pictures, mesh, viewpoint, seen):
    """(t, n) f8: maps (t, h, w) of one view at the vertices that it sees, seen (n,) boolean; zero at the others.

    The thesis draws the projected vertices, and stretches the bounding box of the object in the map onto theirs: a
    Grad-CAM map shows no object whose box could be taken, and boxes of pixels are a pixel off. Here the camera itself
    says where in the picture each vertex lies, to a fraction of a pixel, and exact rays (stages.conspicuity.facing)
    say whether it is seen. Bilinear between pixels.
    """
    pictures, seen = np.asarray(pictures, dtype=np.float64), np.asarray(seen, dtype=bool)
    if pictures.ndim != 3 or seen.shape != (len(mesh.vertices),):
        raise ValueError(f"pictures (t, h, w) and seen ({len(mesh.vertices)},), got {pictures.shape} and {seen.shape}")
    found = np.zeros((len(pictures), len(seen)))
    rows, columns, _ = project(mesh.vertices[seen], viewpoint, pictures.shape[1:])
    for values, picture in zip(found, pictures, strict=True):
        values[seen] = map_coordinates(picture, [rows, columns], order=1, mode="nearest")
    return found


def over_views(values, seen):
    """(t, n): the mean of values (v, t, n) over the views that see each vertex, seen (v, n); 0 where none does."""
    seen = np.asarray(seen, dtype=np.float64)
    looks = seen.sum(axis=0)
    summed = np.einsum("vtn,vn->tn", values, seen)
    return np.divide(summed, looks, out=np.zeros_like(summed), where=looks > 0)
