"""Symmetry of the surface, found in 3D and seen from the view: of both kinds, and of each alone."""

import numpy as np

from stages.kit.mesh import unit

from .memo import once
from .picture import picture
from .planes import shape_symmetries
from .surface import seen, surface_conspicuity

BAND = 0.015  # of the diagonal: how far from a plane of symmetry its points' immediate neighbours reach (one sigma)
KINDS = ("lateral", "radial")  # planes of bilateral symmetry, axes of radial symmetry


def symmetry(mesh, view, filled=True):
    """The symmetry conspicuity map (h / 16, w / 16) f4 in 0..1 (T3.1.1) of a view of a mesh.

    White are the points where planes of symmetry cut the surface and axes of symmetry pierce it. A plane counts with
    the squared sine of its angle to the image, an axis with the squared cosine to the line of sight: seen flat on, a
    plane of symmetry mirrors nothing in the image, and its points lie along the silhouette.
    """
    return _conspicuity(mesh, view, filled, KINDS)


def symmetry_lateral(mesh, view, filled=True):
    """The map as in `symmetry` of bilateral symmetry alone: planes, T3.1.5's SymLat.

    A body of revolution has a plane through its axis for every view, so it is white there along the middle.
    """
    return _conspicuity(mesh, view, filled, ("lateral",))


def symmetry_radial(mesh, view, filled=True):
    """The map as in `symmetry` of radial symmetry alone: where axes pierce the surface, T3.1.5's SymRad."""
    return _conspicuity(mesh, view, filled, ("radial",))


def _conspicuity(mesh, view, filled, kinds):
    image = picture(view, filled)
    if image.empty:
        return image.nothing()
    here = seen(view, mesh)
    return surface_conspicuity(symmetric_points(mesh, here.points, here.back, kinds), mesh, view, filled)


def symmetric_points(mesh, points, back=None, kinds=KINDS):
    """(k,) f8 in 0..1: how near points (k, 3) of the surface are to a plane or an axis of symmetry.

    back (3,): the unit direction to the camera, from which planes and axes are judged; None weighs all alike.
    kinds: which of KINDS count.
    """
    found = found_symmetries(mesh)
    reach = 2 * (BAND * mesh.diagonal) ** 2
    white = np.zeros(len(points))
    for normal, offset, weight in weighted_planes(found, back) if "lateral" in kinds else ():
        np.maximum(white, weight * np.exp(-((points @ normal - offset) ** 2) / reach), out=white)
    away = points - found.centre
    for axis, weight in weighted_axes(found, back) if "radial" in kinds else ():
        distance = (away**2).sum(axis=1) - (away @ axis) ** 2
        np.maximum(white, weight * np.exp(-distance / (4 * reach)), out=white)
    return white


@once
def found_symmetries(mesh):
    """The Symmetries of a mesh, worked out once."""
    return shape_symmetries(mesh)


def weighted_planes(found, back):
    """[(normal (3,), offset, weight)]: the planes, and of the family round a body of revolution the one seen edge-on.

    found: Symmetries; back as in `symmetric_points`.
    """
    planes = list(found.planes)
    for axis, score, revolves in found.axes:
        if revolves and back is not None:
            normal = np.cross(axis, back)
            if np.linalg.norm(normal) > 1e-6:
                normal = unit(normal)
                # It lies edge-on by construction: how well it shows depends on how much of the axis the image shows.
                planes.append((normal, normal @ found.centre, score * (1 - (axis @ back) ** 2)))
    return [(n, offset, score if back is None else score * (1 - (n @ back) ** 2)) for n, offset, score in planes]


def weighted_axes(found, back):
    """[(axis (3,), weight)] of Symmetries; back as in `symmetric_points`."""
    return [(axis, score if back is None else score * (axis @ back) ** 2) for axis, score, _ in found.axes]
