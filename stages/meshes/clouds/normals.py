"""Normals of a point cloud: their lines from the neighbours, their sides from where the points can be seen."""

import numpy as np
from scipy.spatial import ConvexHull, KDTree

from stages.kit.directions import directions

NEIGHBOURS = 12
VIEWS = 32  # directions from which points are looked at
DISTANCE = 3.0  # of the eye, in radii of the cloud
FLIP = 1.3  # exponent of the sphere that points are mirrored on: larger sees more, and through gaps
VOTERS = 20_000  # points that vote; the others follow the nearest of them
ROUNDS, PULL = 30, 2.0  # of the neighbours' influence on each other


def normals_of(points: np.ndarray, sensor: np.ndarray | None = None) -> np.ndarray:
    """(n, 3) unit normals of points (n, 3), towards the sensor (3,), or outwards where it is not known.

    A normal is the direction of least variance of the twelve nearest points. Without a sensor its side is that from
    which the point is seen: from 32 directions the visible points are found without any surface (Katz, Tal, Basri,
    Direct visibility of point sets, SIGGRAPH 2007), each votes for the eye's side, and neighbours pull each other.
    """
    tree = KDTree(points)
    near = tree.query(points, min(NEIGHBOURS, len(points)))[1]
    spread = points[near] - points[near].mean(axis=1, keepdims=True)
    normals = np.linalg.eigh(np.einsum("nki,nkj->nij", spread, spread))[1][:, :, 0]
    if sensor is not None:
        return normals * _sign(np.einsum("ij,ij->i", normals, sensor - points))[:, None]
    voters = np.linspace(0, len(points) - 1, min(VOTERS, len(points))).astype(int)
    votes = _votes(points[voters], normals[voters])
    if len(voters) < len(points):
        nearest = KDTree(points[voters]).query(points)[1]
        votes = votes[nearest] * _sign(np.einsum("ij,ij->i", normals, normals[voters][nearest]))
    alike, side = np.einsum("ni,nki->nk", normals, normals[near]), np.tanh(votes)
    for _ in range(ROUNDS):
        side = np.tanh(votes + PULL * (alike * side[near]).mean(axis=1))
    return normals * _sign(side)[:, None]


def visible(points: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """Ids of the points (n, 3) seen from the eye (3,): those on the hull of all points mirrored on a sphere."""
    ray = points - eye
    length = np.linalg.norm(ray, axis=1, keepdims=True)
    mirrored = ray * (2 * length.max() * 10**FLIP / length - 1)
    hull = ConvexHull(np.vstack([mirrored, np.zeros(3)])).vertices
    return hull[hull < len(points)]


def _votes(points, normals):
    """(n,) how often the side of its normal is seen of each point, less how often the other is."""
    centre = (points.max(axis=0) + points.min(axis=0)) / 2
    radius = np.linalg.norm(points - centre, axis=1).max()
    votes = np.zeros(len(points))
    for direction in directions(VIEWS):
        eye = centre + DISTANCE * radius * direction
        seen = visible(points, eye)
        ray = eye - points[seen]
        along = np.einsum("ij,ij->i", normals[seen], ray) / np.linalg.norm(ray, axis=1)
        votes[seen] += along * np.abs(along)  # a point seen at a slant says little
    return votes


def _sign(values):
    return np.where(values < 0, -1.0, 1.0)
