"""Removes the table that a scanned object stands on (T4.2.3.2)."""

from collections.abc import Iterator

import numpy as np
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, QhullError

from haptic_glance.base.extras import from_extra
from haptic_glance.base.rng import rng

from .mesh import Mesh, unit

DISTANCE = 0.015  # of the diagonal: three standard deviations of a scan with noise of 0.5 %
SAMPLES = 2000  # points on the surface for RANSAC
TRIALS = 1500  # of RANSAC at most: a plane with a fifth of the points is missed in one of 160,000 runs
PLANES = 8  # candidates: a box may have five sides larger than the table
MIN_SHARE = 0.05  # of the surface; a smaller plane is not a table
PARALLEL = np.cos(np.radians(45))  # a face within 45 degrees of the plane, by its smoothed normal, belongs to it
NOISE = 4.0  # standard deviations of the table's roughness that count as table
REFITS = 4  # fits of the plane; converged by then
MIN_TOLERANCE = 0.05  # of the tolerance, for a perfectly smooth table
ONE_SIDED = 0.25  # mean orientation, in -1..1, of a scanned table; a thin base with two sides has 0
MIN_ABOVE = 0.95  # of the remaining area lies on the side that the table faces
MIN_AREA_RATIO = 1.2  # outline of the table over that of the object; a base of the object has 1 at most
MIN_INSIDE = 0.95  # of the object's vertices lie over the outline of the table
MIN_PART = 0.02  # of the largest part's area; smaller parts are fragments of the table, larger ones a lid or a handle


class Plane:
    """A plane normal @ x = offset of unit normal (3,), with the interface of a model for scikit-image's ransac."""

    def __init__(self, normal: np.ndarray, offset: float) -> None:
        self.normal, self.offset = normal, offset

    @classmethod
    def from_estimate(cls, points: np.ndarray, weights: np.ndarray | None = None) -> "Plane":
        """The least-squares plane of points (k, 3), weighted by weights (k,)."""
        centre = np.average(points, axis=0, weights=weights)
        spread = (points - centre) * (1 if weights is None else weights[:, None])
        normal = np.linalg.eigh(spread.T @ (points - centre))[1][:, 0]
        return cls(normal, float(normal @ centre))

    def oriented(self, sign: float) -> "Plane":
        """The same plane; sign -1 reverses its normal."""
        return Plane(sign * self.normal, sign * self.offset)

    def heights(self, points: np.ndarray) -> np.ndarray:
        """(k,) signed distances of points (k, 3)."""
        return points @ self.normal - self.offset

    def residuals(self, points: np.ndarray) -> np.ndarray:
        """(k,) distances of points (k, 3)."""
        return np.abs(self.heights(points))


def remove_plane(mesh: Mesh, distance: float = DISTANCE, seed: int = 0) -> Mesh:
    """The mesh without the table that it stands on, or the mesh itself when no table is found.

    mesh: a scan in any position and size, its faces wound outwards (haptic_glance.mesh.repair). distance: how far the
    table's points may lie from the plane, as a share of the bounding-box diagonal: at least three times the noise of
    the scan. Parts of the object that lie flat within this distance of the table are removed with it.

    The plane is found by RANSAC (T [251]: Fischler and Bolles 1981) on points spread evenly over the surface. It is a
    table, rather than a flat side of the object, under four conditions: it faces the remaining surface (a base faces
    away from it), that surface lies on this side of it and over its outline, and its outline is larger by a fifth.
    A flat brim that was scanned from above only counts as a table for this reason. Remaining parts with less than a
    fiftieth of the largest part's area are removed as fragments of the table. Vertices and faces keep their order.
    Raises ValueError for a mesh without area, or a distance outside 0..0.5.
    """
    if not 0 < distance < 0.5:
        raise ValueError(f"distance must be a share of the diagonal between 0 and 0.5, got {distance}")
    if len(mesh.faces) == 0 or not mesh.face_areas.sum() > 0:
        raise ValueError("the mesh has no surface, so that no plane can be found")
    tolerance = distance * mesh.diagonal
    normals = unit(mesh.vertex_normals[mesh.faces].sum(axis=1))  # smoothed, since noise tilts single faces
    for candidate in _planes(mesh, tolerance, seed):
        plane, flat, cosines = _refined(mesh, candidate, normals, tolerance)
        facing = (mesh.face_areas * cosines)[flat].sum()
        if abs(facing) <= ONE_SIDED * (mesh.face_areas * np.abs(cosines))[flat].sum():
            continue
        plane, table = plane.oriented(np.sign(facing)), flat & (np.sign(facing) * cosines > 0)
        remaining = _large_parts(mesh, ~table)
        if _is_table(mesh, plane, table, remaining, tolerance):
            return _submesh(mesh, remaining)
    return mesh


def _planes(mesh, tolerance, seed) -> Iterator[Plane]:
    """Yields the planes with the most points, each found among the points that are not on the planes before it."""
    with from_extra():  # slow to import, and most runs remove no table
        from skimage.measure import ransac

    generator = rng(seed, "remove_plane")
    points = _sampled(mesh, generator)
    for _ in range(PLANES):
        if len(points) < MIN_SHARE * SAMPLES:
            return
        limits = {"max_trials": TRIALS, "stop_probability": 0.9999}
        plane, inliers = ransac(points, Plane, 3, tolerance, rng=generator, **limits)
        near = np.zeros(len(points), dtype=bool) if inliers is None else np.asarray(inliers)
        if plane is None or near.sum() < MIN_SHARE * SAMPLES:
            return
        yield plane
        points = points[~near]


def _sampled(mesh, generator):
    """(SAMPLES, 3) points spread evenly over the surface."""
    face = generator.choice(len(mesh.faces), SAMPLES, p=mesh.face_areas / mesh.face_areas.sum())
    low, high = np.sort(generator.random((2, SAMPLES)), axis=0)
    weights = np.stack([low, high - low, 1 - high], axis=1)
    return np.einsum("ij,ijk->ik", weights, mesh.vertices[mesh.faces[face]])


def _refined(mesh, plane, normals, tolerance):
    """(Plane, (m,) boolean: the faces that lie in it, (m,) cosines to its normal), fitted to the table's roughness.

    Flat surface just above the table biases the first fit, so the plane is fitted again to the nearest faces.
    """
    near, flat, along = tolerance, np.zeros(len(mesh.faces), dtype=bool), np.zeros(len(mesh.faces))
    for _ in range(REFITS):
        along = normals @ plane.normal
        flat = (plane.residuals(mesh.vertices)[mesh.faces].max(axis=1) <= near) & (np.abs(along) > PARALLEL)
        if not mesh.face_areas[flat].any():  # none is there, or slivers alone
            break
        plane = Plane.from_estimate(mesh.vertices[mesh.faces[flat, 0]], mesh.face_areas[flat])
        residuals = plane.residuals(mesh.vertices[mesh.faces[flat, 0]])
        deviation = 1.4826 * _median(residuals, mesh.face_areas[flat])  # standard deviation of a Gaussian
        near = np.clip(NOISE * deviation, MIN_TOLERANCE * tolerance, tolerance)
    return plane, flat, along


def _median(values, weights):
    """The weighted median of values (k,) with weights (k,)."""
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    return values[order][np.searchsorted(below, below[-1] / 2)]


def _large_parts(mesh, faces):
    """(m,) boolean: of the faces (m,) boolean, in parts with at least MIN_PART of the largest part's area."""
    patch = Mesh(mesh.vertices, mesh.faces[faces])
    part = connected_components(patch.adjacency, directed=False)[1][patch.faces[:, 0]]
    area = np.bincount(part, weights=patch.face_areas, minlength=1)
    large = np.zeros(len(mesh.faces), dtype=bool)
    large[faces] = (area >= MIN_PART * area.max())[part]
    return large


def _is_table(mesh, plane, table, remaining, tolerance):
    """Whether the plane, whose normal agrees with the faces `table`, carries the faces `remaining`."""
    areas = mesh.face_areas
    if not remaining.any() or areas[table].sum() < MIN_SHARE * areas.sum():
        return False
    height = plane.heights(mesh.vertices[mesh.faces[remaining]].mean(axis=1))
    if areas[remaining][height > -tolerance].sum() < MIN_ABOVE * areas[remaining].sum():
        return False
    across = np.linalg.svd(plane.normal[None])[2][1:].T
    under, above = (mesh.vertices[np.unique(mesh.faces[faces])] @ across for faces in (table, remaining))
    try:
        table_hull, object_hull = ConvexHull(under), ConvexHull(above)
    except QhullError:  # collinear points have no hull
        return False
    inside = (above @ table_hull.equations[:, :2].T + table_hull.equations[:, 2] <= 0).all(axis=1)
    # `volume` of a planar hull is its area.
    return table_hull.volume >= MIN_AREA_RATIO * object_hull.volume and inside.mean() >= MIN_INSIDE


def _submesh(mesh, faces):
    """The Mesh of the faces (m,) boolean, with only their vertices."""
    vertices, ids = np.unique(mesh.faces[faces], return_inverse=True)
    colors, texture = (None if mesh.colors is None else mesh.colors[vertices]), mesh.texture and mesh.texture.of(faces)
    return Mesh(mesh.vertices[vertices], ids.reshape(-1, 3), colors, texture, mesh.up)
