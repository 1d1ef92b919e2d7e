"""The channels of symmetry, bilateral and radial: planes and axes of the 3D shape, projected to the view.

The search finds exact and approximate symmetries.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from operator import itemgetter

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.mesh.mesh import Mesh, unit

from ..views import View
from .surface import surface_conspicuity, visible_surface

DENSE, SPARSE = 8000, 600  # points that represent the surface, and points that are mirrored onto it
SEARCH = 120  # of the sparse points, enough to rank the directions before refinement
DIRECTIONS = 200  # over the half sphere, 10 degrees apart: close enough for the refinement to converge
STARTS = 10  # best directions that are refined
STEPS = 12  # of the refinement, enough to converge
SEPARATION = np.cos(np.radians(25))  # planes closer than this are duplicates
TOLERANCE = 0.015  # of the diagonal: distance (rms) of mirrored points from the surface at which the score is 1 / e
MIN_SCORE = 0.7  # of a symmetry that people see
MIN_GAIN = 0.1  # of a plane over the body of revolution around its axis: a cup's plane through the handle
ORDERS = (3, 4, 5, 6)  # of rotational symmetry; order two is not perceived as radial
GENERIC = (50.0, 95.0, 222.5)  # degrees, of no low order: only a body of revolution is symmetric under all of them


@dataclass(frozen=True)
class Symmetries:
    """centre (3,) of the surface; planes [(unit normal (3,), offset, score)]; axes [(unit axis (3,), score, revolves)].

    Axes run through the centre. Scores in 0..1; `revolves`: the shape is a body of revolution around this axis.
    """

    centre: np.ndarray
    planes: tuple
    axes: tuple


@weak_cache
def shape_symmetries(mesh: Mesh, strongest: bool = False, /) -> Symmetries:
    """The Symmetries of a mesh: planes of bilateral and axes of radial symmetry that score at least MIN_SCORE.

    strongest: where no plane or no axis scores that much, the best one counts, and all scores are 1.

    Candidate planes go through the centre of the surface. Their normals are the principal axes and directions spread
    over the half sphere, the best of which are refined (`_refine`); after Podolak et al., A planar-reflective symmetry
    transform for 3D shapes, SIGGRAPH 2006, with points instead of a grid. The score is exp(-(d / tolerance)^2), where d
    is the distance (rms) of mirrored points to the surface, so that a spout or handle without a counterpart lowers it.
    An axis of order three or more is a principal axis, or lies in several mirror planes. A shape that is symmetric in
    every direction (a sphere) has no distinct symmetry, so that none is returned; nor is any for a mesh without area.
    """
    if not mesh.face_areas.sum() > 0:
        return Symmetries(np.zeros(3), (), ())
    dense = sample_surface(mesh, DENSE)
    surface = SampledSurface(dense, mesh.diagonal, sample_surface(mesh, SPARSE))
    principal = np.linalg.eigh(_products(dense, dense))[1].T
    mirrors = _mirror_planes(surface, principal)
    planes = [plane for plane in mirrors if plane[2] >= MIN_SCORE]
    candidates = _axes(surface, principal, planes)
    axes = [axis for axis in candidates if axis[1] >= MIN_SCORE]
    revolution = [(axis, score) for axis, score, revolves in axes if revolves]
    if len(revolution) > 1:
        return Symmetries(surface.centre, (), ())
    distinct = [p for p in planes if not any(_through_axis(p, *axis) for axis in revolution)]
    if strongest:
        axes = axes or [max(candidates, key=itemgetter(1))]
        distinct = [(n, d, 1.0) for n, d, _ in distinct or ([] if revolution else mirrors[:1])]
        axes = [(axis, 1.0, revolves) for axis, _, revolves in axes]
    return Symmetries(surface.centre, tuple(distinct), tuple(axes))


def _through_axis(plane, axis, score):
    """Whether a plane is one of the many through the axis of a body of revolution, none of which is distinct."""
    return abs(plane[0] @ axis) < 0.1 and plane[2] < score + MIN_GAIN


class SampledSurface:
    """Points that represent a surface, and the distance of other points from it."""

    def __init__(self, dense: np.ndarray, diagonal: float, sparse: np.ndarray) -> None:
        self.tree, self.dense, self.sparse = KDTree(dense), dense, sparse
        self.centre = dense.mean(axis=0)
        self.tolerance = TOLERANCE * diagonal
        self.floor = self.error(sparse)  # the distance of points that lie on the surface

    def score(self, moved: np.ndarray) -> float:
        """exp(-(d / tolerance)^2) of moved points (k, 3), d the root of their mean squared distance."""
        return float(np.exp(-max(self.error(moved) - self.floor, 0) / self.tolerance**2))

    def error(self, moved: np.ndarray) -> np.ndarray:
        """Mean squared distance of moved points (..., k, 3): (...)."""
        return (self.tree.query(moved)[0] ** 2).mean(axis=-1)


def sample_surface(mesh: Mesh, count: int) -> np.ndarray:
    """Points (count, 3) spread evenly over the surface by area, the same at every call.

    Stratified over the cumulative area of the faces; within the faces the points follow the R2 sequence (Roberts 2018).
    """
    cumulative_areas = np.cumsum(mesh.face_areas)
    faces = np.searchsorted(cumulative_areas, (np.arange(count) + 0.5) / count * cumulative_areas[-1])
    u, v = (0.5 + np.outer([0.7548776662466927, 0.5698402909980532], np.arange(count))) % 1
    is_outside = u + v > 1
    u, v = np.where(is_outside, 1 - u, u), np.where(is_outside, 1 - v, v)
    a, b, c = mesh.vertices[mesh.faces[faces]].transpose(1, 0, 2)
    return a + u[:, None] * (b - a) + v[:, None] * (c - a)


def mirror(points: np.ndarray, normal: np.ndarray, offset: float) -> np.ndarray:
    """Points (k, 3) mirrored at the plane normal @ x = offset."""
    return points - 2 * (points @ normal - offset)[:, None] * normal


def rotate(points: np.ndarray, axis: np.ndarray, angle: float, centre: np.ndarray) -> np.ndarray:
    """Points (k, 3) rotated by an angle in degrees about an axis through the centre (Rodrigues)."""
    offsets = points - centre
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    along = (offsets @ axis)[:, None] * axis
    return centre + along + cosine * (offsets - along) + sine * np.cross(axis, offsets)


def _mirror_planes(surface, principal):
    directions = np.concatenate([principal, _half_sphere(DIRECTIONS)])
    points = surface.sparse[:: max(len(surface.sparse) // SEARCH, 1)]
    errors = surface.error(np.stack([mirror(points, n, n @ surface.centre) for n in directions]))
    starts = _distinct(directions[np.argsort(errors, kind="stable")])[:STARTS]
    refined = [_refine(surface, points, normal) for normal in [*principal, *starts]]
    scores = [surface.score(mirror(surface.sparse, n, d)) for n, d in refined]
    ranked = [(*refined[k], scores[k]) for k in np.argsort(scores, kind="stable")[::-1]]
    distinct = _distinct([n for n, _, _ in ranked], positions=True)
    return [ranked[k] for k in distinct]


def _refine(surface, points, normal):
    """(normal, offset) of the plane near an initial normal that best mirrors the points onto the surface.

    Iterative closest points: with q the surface point nearest to the mirrored p, the best normal minimises n'pq'n over
    the centred pairs, which is an eigenvector, and the plane lies half-way between the two means.
    """
    offset = normal @ surface.centre
    for _ in range(STEPS):
        nearest = surface.dense[surface.tree.query(mirror(points, normal, offset))[1]]
        values = _products(points, nearest)
        normal = np.linalg.eigh(values + values.T)[1][:, 0]
        offset = normal @ (points.mean(axis=0) + nearest.mean(axis=0)) / 2
    return normal, offset


def _products(p, q):
    """(3, 3) sum of outer products of two centred point sets (k, 3). Not by BLAS, whose sums depend on its threads."""
    return ((p - p.mean(axis=0))[:, :, None] * (q - q.mean(axis=0))[:, None, :]).sum(axis=0)


def _axes(surface, principal, planes):
    crossings = [np.cross(a[0], b[0]) for i, a in enumerate(planes) for b in planes[:i]]
    candidates = _distinct([*principal, *(unit(c) for c in crossings if np.linalg.norm(c) > 0.2)])
    axes = []
    for axis in candidates:
        score = min(_rotation_score(surface, axis, angle) for angle in GENERIC)
        revolves = score >= MIN_SCORE
        if not revolves:
            score = max(_rotation_score(surface, axis, 360 / n) for n in ORDERS)
        axes.append((axis, score, revolves))
    return axes


def _rotation_score(surface, axis, angle):
    return surface.score(rotate(surface.sparse, axis, angle, surface.centre))


def _distinct(directions, positions=False):
    """The directions (or their positions) that are not near an earlier one, up to sign."""
    distinct_ids = []
    for k, direction in enumerate(directions):
        if all(abs(direction @ directions[earlier]) < SEPARATION for earlier in distinct_ids):
            distinct_ids.append(k)
    return distinct_ids if positions else [directions[k] for k in distinct_ids]


def _half_sphere(count):
    """(count, 3) unit directions spread evenly over the half sphere z > 0 (Fibonacci lattice)."""
    k = np.arange(count)
    z = (k + 0.5) / count
    angle = k * np.pi * (3 - np.sqrt(5))
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


BAND = 0.015  # of the diagonal: standard deviation of the response around a plane of symmetry
KINDS = ("lateral", "radial")  # planes of bilateral symmetry, axes of radial symmetry


def symmetry(
    mesh: Mesh, view: View, filled: bool = True, kinds: Sequence[str] = KINDS, strongest: bool = False
) -> np.ndarray:
    """The symmetry conspicuity map (h / 16, w / 16) f4 in 0..1 (T3.1.1) of a view of a mesh.

    The response is high where planes of symmetry cut the surface and axes of symmetry pierce it. A plane is weighted
    by the squared sine of its angle to the image, an axis by the squared cosine of its angle to the line of sight: a
    plane parallel to the image mirrors nothing in it, and its points lie along the silhouette. kinds: which of KINDS
    count, `lateral` alone for SymLat of T3.1.5, `radial` for SymRad. A body of revolution has a plane through its axis
    for every view, so that its lateral response is high along the middle. strongest: the strongest plane and axis
    count, however weak, so that each object has points, as in T3.1.5.
    """
    response = np.max([_seen_symmetry(view, mesh, kind, strongest) for kind in kinds], axis=0)
    return surface_conspicuity(response, mesh, view, filled)


@weak_cache
def _seen_symmetry(view, mesh, kind, strongest):
    """symmetric_points of one kind at the points of visible_surface, which two channels use."""
    surface = visible_surface(view, mesh)
    return symmetric_points(mesh, surface.points, surface.back, (kind,), strongest)


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
    symmetries = shape_symmetries(mesh, strongest)
    spread = 2 * (BAND * mesh.diagonal) ** 2
    response = np.zeros(len(points))
    for normal, offset, weight in weighted_planes(symmetries, back) if "lateral" in kinds else ():
        np.maximum(response, weight * np.exp(-((points @ normal - offset) ** 2) / spread), out=response)
    offsets = points - symmetries.centre
    square = np.einsum("ij,ij->i", offsets, offsets)
    for axis, weight in weighted_axes(symmetries, back) if "radial" in kinds else ():
        distance = square - (offsets @ axis) ** 2
        np.maximum(response, weight * np.exp(-distance / (4 * spread)), out=response)
    return response


def weighted_planes(symmetries: Symmetries, back: np.ndarray | None) -> list[tuple[np.ndarray, float, float]]:
    """[(normal (3,), offset, weight)]: the planes, and of those through an axis of revolution the one seen edge-on.

    symmetries: Symmetries; back as in `symmetric_points`.
    """
    planes = list(symmetries.planes)
    for axis, score, revolves in symmetries.axes:
        if revolves and back is not None:
            normal = np.cross(axis, back)
            if np.linalg.norm(normal) > 1e-6:
                normal = unit(normal)
                # It is edge-on by construction, so its weight depends on the angle of the axis to the image.
                planes.append((normal, normal @ symmetries.centre, score * (1 - (axis @ back) ** 2)))
    return [(n, offset, score if back is None else score * (1 - (n @ back) ** 2)) for n, offset, score in planes]


def weighted_axes(symmetries: Symmetries, back: np.ndarray | None) -> list[tuple[np.ndarray, float]]:
    """[(axis (3,), weight)] of Symmetries; back as in `symmetric_points`."""
    return [(axis, score if back is None else score * (axis @ back) ** 2) for axis, score, _ in symmetries.axes]
