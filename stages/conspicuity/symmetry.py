"""Symmetry of the surface, found in 3D and seen from the view."""

import numpy as np

from stages.kit.mesh import unit

from .memo import once
from .picture import picture
from .planes import shape_symmetries
from .surface import seen, surface_conspicuity

BAND = 0.015  # of the diagonal: how far from a plane of symmetry its points' immediate neighbours reach (one sigma)


def symmetry(mesh, view, filled=True):
    """The symmetry conspicuity map (h / 16, w / 16) f4 in 0..1 (T3.1.1) of a view of a mesh.

    White are the points where planes of symmetry cut the surface and axes of symmetry pierce it. A plane counts with
    the squared sine of its angle to the image, an axis with the squared cosine to the line of sight: seen flat on, a
    plane of symmetry mirrors nothing in the image, and its points lie along the silhouette.
    """
    image = picture(view, filled)
    if image.empty:
        return image.nothing()
    here = seen(view, mesh)
    return surface_conspicuity(symmetric_points(mesh, here.points, here.back), mesh, view, filled)


def symmetric_points(mesh, points, back=None):
    """(k,) f8 in 0..1: how near points (k, 3) of the surface are to a plane or an axis of symmetry.

    back (3,): the unit direction to the camera, from which planes and axes are judged; None weighs all alike.
    """
    found = found_symmetries(mesh)
    reach = 2 * (BAND * mesh.diagonal) ** 2
    white = np.zeros(len(points))
    for normal, offset, score in _planes_seen(found, back):
        weight = score if back is None else score * (1 - (normal @ back) ** 2)
        np.maximum(white, weight * np.exp(-((points @ normal - offset) ** 2) / reach), out=white)
    for axis, score, _ in found.axes:
        weight = score if back is None else score * (axis @ back) ** 2
        away = points - found.centre
        distance = (away**2).sum(axis=1) - (away @ axis) ** 2
        np.maximum(white, weight * np.exp(-distance / (4 * reach)), out=white)
    return white


@once
def found_symmetries(mesh):
    """The Symmetries of a mesh, worked out once."""
    return shape_symmetries(mesh)


def _planes_seen(found, back):
    """The planes (normal, offset, score), and of the family round a body of revolution the one seen edge-on."""
    planes = list(found.planes)
    for axis, score, revolves in found.axes:
        if revolves and back is not None:
            normal = np.cross(axis, back)
            if np.linalg.norm(normal) > 1e-6:
                normal = unit(normal)
                # It lies edge-on by construction: how well it shows depends on how much of the axis the image shows.
                planes.append((normal, normal @ found.centre, score * (1 - (axis @ back) ** 2)))
    return planes
