"""Takes out the table that a scanned object stands on (T4.2.3.2)."""

import numpy as np
from scipy.sparse.csgraph import connected_components
from scipy.spatial import ConvexHull, QhullError

from stages.kit import Mesh
from stages.kit.mesh import unit
from stages.kit.rng import rng

DISTANCE = 0.015  # of the diagonal: three standard deviations of a scan whose noise is half a per cent of it
SAMPLES = 2000  # points on the surface that RANSAC looks at
TRIALS = 1500  # draws of three points at most: a plane with a fifth of the points is met by then but once in 160,000
PLANES = 8  # candidates: a box may show five sides that are larger than the table
LEAST_SHARE = 0.05  # of the surface; a smaller plane is no table
ALONG = np.cos(np.radians(45))  # a face within 45 degrees of the plane is the plane's, once its normal is smoothed
NOISE = 4.0  # standard deviations of the table's own roughness that are the table's
REFITS = 4  # fits of the plane; the last ones change nothing
CLOSE = 0.05  # of the reach, which a smooth table's faces keep to
ONE_SIDED = 0.25  # a table is seen from the object's side; a thin base, seen from both, comes to 0 of -1..1
ONE_SIDE = 0.95  # of the rest's area lies on the side that the table faces
BEYOND = 1.2  # a table's outline has so many times the area of the object's; a base or floor of its own has at most one
WITHIN = 0.95  # of the object's vertices stand over the table
PART = 0.02  # of the largest part's area: what is smaller is a crumb of the table, what is larger a lid or a handle


class Plane:
    """A plane of unit normal (3,) and offset, in the form that scikit-image's ransac asks of a model."""

    def __init__(self, normal, offset):
        self.normal, self.offset = normal, offset

    @classmethod
    def from_estimate(cls, points, weights=None):
        """The plane nearest to points (k, 3) in least squares, weighed by weights (k,)."""
        centre = np.average(points, axis=0, weights=weights)
        spread = (points - centre) * (1 if weights is None else weights[:, None])
        normal = np.linalg.eigh(spread.T @ (points - centre))[1][:, 0]
        return cls(normal, normal @ centre)

    def turned(self, sign):
        """The same plane, its normal the other way for sign -1."""
        return Plane(sign * self.normal, sign * self.offset)

    def heights(self, points):
        """(k,) signed distances of points (k, 3)."""
        return points @ self.normal - self.offset

    def residuals(self, points):
        """(k,) distances of points (k, 3)."""
        return np.abs(self.heights(points))


def remove_plane(mesh, distance=DISTANCE, seed=0):
    """The mesh without the table that it stands on; the mesh itself where no table is found.

    mesh: a scan in any position and size, its faces wound outwards (stages.meshes.clean). distance: how far from the
    plane the table's points may lie, a share of the diagonal of the bounding box: three times the scan's noise or more.
    What of the object lies flat and lower than this above the table goes with it.

    The plane comes from RANSAC (T [251]: Fischler and Bolles 1981) on points spread evenly over the surface. It is a
    table, and no flat side of the object, where it faces the rest (a base looks away from it), all the rest lies on
    that side and over the plane's outline, and that outline is larger by a fifth. So a flat brim that was seen from
    above alone counts as a table. Of what is left, parts with less than a fiftieth of the largest one's area go, too,
    as crumbs of the table; vertices and faces keep their order. ValueError for a mesh without area or a distance
    outside 0..0.5.
    """
    if not 0 < distance < 0.5:
        raise ValueError(f"distance must be a share of the diagonal between 0 and 0.5, got {distance}")
    if len(mesh.faces) == 0 or not mesh.face_areas.sum() > 0:
        raise ValueError("the mesh has no surface to find a plane in")
    reach = distance * mesh.diagonal
    normals = unit(mesh.vertex_normals[mesh.faces].sum(axis=1))  # smoothed: noise tilts single faces at random
    for plane in _planes(mesh, reach, seed):
        plane, flat, along = _refined(mesh, plane, normals, reach)
        lean = (mesh.face_areas * along)[flat].sum()
        if abs(lean) <= ONE_SIDED * (mesh.face_areas * np.abs(along))[flat].sum():
            continue
        plane, table = plane.turned(np.sign(lean)), flat & (np.sign(lean) * along > 0)
        standing = _large_parts(mesh, ~table)
        if _is_table(mesh, plane, table, standing, reach):
            return _only(mesh, standing)
    return mesh


def _planes(mesh, reach, seed):
    """The planes with the most surface, one after another, each among the points that those before have left."""
    from skimage.measure import ransac  # loads slowly, and most runs need no table removed

    draw = rng(seed, "remove_plane")
    points = _sampled(mesh, draw)
    for _ in range(PLANES):
        if len(points) < LEAST_SHARE * SAMPLES:
            return
        plane, near = ransac(points, Plane, 3, reach, max_trials=TRIALS, stop_probability=0.9999, rng=draw)
        if near is None or near.sum() < LEAST_SHARE * SAMPLES:
            return
        yield plane
        points = points[~near]


def _sampled(mesh, draw):
    """(SAMPLES, 3) points spread evenly over the surface."""
    face = draw.choice(len(mesh.faces), SAMPLES, p=mesh.face_areas / mesh.face_areas.sum())
    low, high = np.sort(draw.random((2, SAMPLES)), axis=0)
    weights = np.stack([low, high - low, 1 - high], axis=1)
    return np.einsum("ij,ijk->ik", weights, mesh.vertices[mesh.faces[face]])


def _refined(mesh, plane, normals, reach):
    """(Plane, (m,) boolean: the faces in and along it, (m,) cosines to its normal), as near as its roughness allows.

    What lies flat and close above the table bends the first fit, so the plane is fitted again to what keeps nearest.
    """
    near = reach
    for _ in range(REFITS):
        along = normals @ plane.normal
        flat = (plane.residuals(mesh.vertices)[mesh.faces].max(axis=1) <= near) & (np.abs(along) > ALONG)
        if not flat.any():
            break
        plane = Plane.from_estimate(mesh.vertices[mesh.faces[flat, 0]], mesh.face_areas[flat])
        residuals = plane.residuals(mesh.vertices[mesh.faces[flat, 0]])
        deviation = 1.4826 * _median(residuals, mesh.face_areas[flat])  # of a Gaussian
        near = np.clip(NOISE * deviation, CLOSE * reach, reach)
    return plane, flat, along


def _median(values, weights):
    """The value (k,) below which half of the weights (k,) lie."""
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    return values[order][np.searchsorted(below, below[-1] / 2)]


def _large_parts(mesh, faces):
    """(m,) boolean: of the faces (m,) boolean, those in parts with PART of the largest part's area or more."""
    chosen = Mesh(mesh.vertices, mesh.faces[faces])
    part = connected_components(chosen.adjacency, directed=False)[1][chosen.faces[:, 0]]
    area = np.bincount(part, weights=chosen.face_areas, minlength=1)
    large = np.zeros(len(mesh.faces), dtype=bool)
    large[faces] = (area >= PART * area.max())[part]
    return large


def _is_table(mesh, plane, table, standing, reach):
    """True where the plane, its normal on the side that the faces `table` show, carries what is `standing`."""
    areas = mesh.face_areas
    if not standing.any() or areas[table].sum() < LEAST_SHARE * areas.sum():
        return False
    height = plane.heights(mesh.vertices[mesh.faces[standing]].mean(axis=1))
    if areas[standing][height > -reach].sum() < ONE_SIDE * areas[standing].sum():
        return False
    across = np.linalg.svd(plane.normal[None])[2][1:].T
    under, above = (mesh.vertices[np.unique(mesh.faces[faces])] @ across for faces in (table, standing))
    try:
        outline, own = ConvexHull(under), ConvexHull(above)
    except QhullError:  # a line has no outline
        return False
    inside = (above @ outline.equations[:, :2].T + outline.equations[:, 2] <= 0).all(axis=1)
    return outline.volume >= BEYOND * own.volume and inside.mean() >= WITHIN  # of a plane hull, its area


def _only(mesh, faces):
    """The Mesh of the faces (m,) boolean and their vertices."""
    used, ids = np.unique(mesh.faces[faces], return_inverse=True)
    colors, texture = (None if mesh.colors is None else mesh.colors[used]), mesh.texture and mesh.texture.of(faces)
    return Mesh(mesh.vertices[used], ids.reshape(-1, 3), colors, texture)
