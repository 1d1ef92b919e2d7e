"""The projection of image maps to the vertices of the mesh (T3.3.5)."""

import numpy as np
from scipy.ndimage import map_coordinates

from haptic_glance.look.camera import Viewpoint, project
from haptic_glance.mesh.mesh import Mesh

PROJECTIONS = ("camera", "boxes")  # ours, and T3.3.5 as printed


def project_to_vertices(pictures: np.ndarray, mesh: Mesh, viewpoint: Viewpoint, seen: np.ndarray) -> np.ndarray:
    """(t, n) f8: maps (t, h, w) of one view at its visible vertices, seen (n,) boolean; zero at the others.

    The camera gives the position of each vertex in the image to a fraction of a pixel, and rays
    (haptic_glance.look.channels.cropped_view) decide which vertices are visible. Interpolates bilinearly between
    pixels.
    """
    pictures, seen = _checked(pictures, mesh, seen)
    found = np.zeros((len(pictures), len(seen)))
    rows, columns, _ = project(mesh.vertices[seen], viewpoint, pictures.shape[1:])
    for values, picture in zip(found, pictures, strict=True):
        values[seen] = map_coordinates(picture, [rows, columns], order=1, mode="nearest")
    return found


def project_by_boxes(
    pictures: np.ndarray, mesh: Mesh, viewpoint: Viewpoint, seen: np.ndarray, render: np.ndarray
) -> np.ndarray:
    """(t, n) f8: as project_to_vertices, by bounding boxes as T3.3.5 prints it; render (h, w): the object on black.

    The box of the projected vertices, hidden ones too, is stretched to that of the object in the picture, and each
    vertex takes the pixel that it falls on. Raises ValueError for a picture without an object.
    """
    pictures, seen = _checked(pictures, mesh, seen)
    if render.shape != pictures.shape[1:] or not render.any():
        raise ValueError(f"render must show an object on {pictures.shape[1:]} pixels, got {render.shape}")
    places = (mesh.vertices @ viewpoint.axes[:2].T * [1, -1])[:, ::-1]  # down and to the right
    low, extent = places.min(axis=0), np.ptp(places, axis=0)
    lines = np.nonzero(render.any(axis=1))[0], np.nonzero(render.any(axis=0))[0]
    first, last = ([line[end] for line in lines] for end in (0, -1))
    shares = (places - low) / np.where(extent > 0, extent, 1)
    rows, columns = np.rint(first + shares * np.subtract(last, first)).astype(np.int64).T
    return pictures[:, rows, columns] * seen


def _checked(pictures: np.ndarray, mesh: Mesh, seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    pictures, seen = np.asarray(pictures, dtype=np.float64), np.asarray(seen, dtype=bool)
    if pictures.ndim != 3 or seen.shape != (len(mesh.vertices),):
        raise ValueError(f"pictures (t, h, w) and seen ({len(mesh.vertices)},), got {pictures.shape} and {seen.shape}")
    return pictures, seen


def mean_over_views(values: np.ndarray, seen: np.ndarray) -> np.ndarray:
    """(t, n): the mean of values (v, t, n) over the views that see each vertex, seen (v, n) boolean; 0 without any."""
    seen = np.asarray(seen, dtype=np.float64)
    views = seen.sum(axis=0)
    summed = np.einsum("vtn,vn->tn", values, seen)
    return np.divide(summed, views, out=np.zeros_like(summed), where=views > 0)
