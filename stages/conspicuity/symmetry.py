"""Symmetry of the shape, found in 3D and projected to the view: bilateral and radial, together and each alone."""

from collections.abc import Sequence

import numpy as np

from stages.kit import Mesh
from stages.kit.mesh import unit
from stages.views import View

from .cropped_view import cropped_view
from .surface import surface_conspicuity, visible_surface
from .symmetry_search import Symmetries, shape_symmetries
from .weak_cache import weak_cache

BAND = 0.015  # of the diagonal: standard deviation of the response around a plane of symmetry
KINDS = ("lateral", "radial")  # planes of bilateral symmetry, axes of radial symmetry


def symmetry(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The symmetry conspicuity map (h / 16, w / 16) f4 in 0..1 (T3.1.1) of a view of a mesh.

    The response is high where planes of symmetry cut the surface and axes of symmetry pierce it. A plane is weighted
    by the squared sine of its angle to the image, an axis by the squared cosine of its angle to the line of sight: a
    plane parallel to the image mirrors nothing in it, and its points lie along the silhouette.
    """
    return _conspicuity(mesh, view, filled, KINDS)


def symmetry_lateral(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The map as in `symmetry` of bilateral symmetry alone: planes, SymLat of T3.1.5.

    A body of revolution has a plane through its axis for every view, so the response is high along the middle.
    """
    return _conspicuity(mesh, view, filled, ("lateral",))


def symmetry_radial(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The map as in `symmetry` of radial symmetry alone: where axes pierce the surface, SymRad of T3.1.5."""
    return _conspicuity(mesh, view, filled, ("radial",))


def symmetry_strongest(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The map as in `symmetry` of the strongest plane and axis, however weak: each object has points, as in T3.1.5."""
    return _conspicuity(mesh, view, filled, KINDS, strongest=True)


def symmetry_strongest_lateral(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The map as in `symmetry_strongest` of bilateral symmetry alone."""
    return _conspicuity(mesh, view, filled, ("lateral",), strongest=True)


def symmetry_strongest_radial(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The map as in `symmetry_strongest` of radial symmetry alone."""
    return _conspicuity(mesh, view, filled, ("radial",), strongest=True)


def _conspicuity(mesh, view, filled, kinds, strongest=False):
    image = cropped_view(view, filled)
    if image.empty:
        return image.zero_map()
    response = np.max([_seen_symmetry(view, mesh, kind, strongest) for kind in kinds], axis=0)
    return surface_conspicuity(response, mesh, view, filled)


@weak_cache
def _seen_symmetry(view, mesh, kind, strongest):
    """symmetric_points of one kind at the points of visible_surface, which two channels use."""
    seen = visible_surface(view, mesh)
    return symmetric_points(mesh, seen.points, seen.back, (kind,), strongest)


def symmetric_points(
    mesh: Mesh,
    points: np.ndarray,
    back: np.ndarray | None = None,
    kinds: Sequence[str] = KINDS,
    strongest: bool = False,
) -> np.ndarray:
    """(k,) f8 in 0..1: how near points (k, 3) of the surface are to a plane or an axis of symmetry.

    back (3,): the unit direction to the camera, by which planes and axes are weighted; None weights all equally.
    kinds: which of KINDS count. strongest: as in `shape_symmetries`.
    """
    found = symmetries(mesh, strongest)
    spread = 2 * (BAND * mesh.diagonal) ** 2
    response = np.zeros(len(points))
    for normal, offset, weight in weighted_planes(found, back) if "lateral" in kinds else ():
        np.maximum(response, weight * np.exp(-((points @ normal - offset) ** 2) / spread), out=response)
    away = points - found.centre
    square = np.einsum("ij,ij->i", away, away)
    for axis, weight in weighted_axes(found, back) if "radial" in kinds else ():
        distance = square - (away @ axis) ** 2
        np.maximum(response, weight * np.exp(-distance / (4 * spread)), out=response)
    return response


@weak_cache
def symmetries(mesh: Mesh, strongest: bool = False) -> Symmetries:
    """The Symmetries of a mesh, cached; strongest: as in `shape_symmetries`."""
    return shape_symmetries(mesh, strongest)


def weighted_planes(found: Symmetries, back: np.ndarray | None) -> list[tuple[np.ndarray, float, float]]:
    """[(normal (3,), offset, weight)]: the planes, and of those through an axis of revolution the one seen edge-on.

    found: Symmetries; back as in `symmetric_points`.
    """
    planes = list(found.planes)
    for axis, score, revolves in found.axes:
        if revolves and back is not None:
            normal = np.cross(axis, back)
            if np.linalg.norm(normal) > 1e-6:
                normal = unit(normal)
                # It is edge-on by construction, so its weight depends on the angle of the axis to the image.
                planes.append((normal, normal @ found.centre, score * (1 - (axis @ back) ** 2)))
    return [(n, offset, score if back is None else score * (1 - (n @ back) ** 2)) for n, offset, score in planes]


def weighted_axes(found: Symmetries, back: np.ndarray | None) -> list[tuple[np.ndarray, float]]:
    """[(axis (3,), weight)] of Symmetries; back as in `symmetric_points`."""
    return [(axis, score if back is None else score * (axis @ back) ** 2) for axis, score, _ in found.axes]
