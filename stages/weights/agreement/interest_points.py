"""Agreement of detected interest points with those of people: false negatives, false positives, weighted misses.

Source: Dutagaci, Cheung and Godil, Evaluation of 3D interest point detection techniques via human-generated ground
truth, The Visual Computer 2012, section on evaluation measures (T's reference 7).
"""

import numpy as np

from stages.kit import Mesh

from .geodesic import geodesics

TOLERANCES = np.linspace(0.0, 0.12, 13)  # of the diagonal: the range of the paper's curves


def interest_point_errors(
    mesh: Mesh,
    detected: np.ndarray,
    points: np.ndarray,
    weights: np.ndarray | None = None,
    tolerances: np.ndarray = TOLERANCES,
) -> dict[str, np.ndarray]:
    """Errors of the detected vertices against the points of people: dict of fne, fpe and wme, each (t,) in 0..1.

    detected (a,) and points (g,) are vertex ids. A point is found at tolerance r if a detected vertex lies within the
    geodesic distance r of it and no nearer to another point; a detected vertex finds at most one point.
    fne = 1 - found / g; fpe = 1 - found / a; wme = 1 - weight of the found / weight of all. tolerances (t,) are shares
    of the bounding-box diagonal. weights: the number of people who marked each point, (g,), or (g, t) if it is counted
    at each tolerance as in the paper. Any other amount can be used; None weights all equally.

    If two points are equally near, the heavier one gets the vertex. Without detections fpe is 0, fne 1 and wme 1.
    Raises ValueError for no points, a repeated point, ids outside the mesh, or bad weights.
    """
    points, tolerances = _vertex_ids(mesh, points, "points"), _checked_tolerances(tolerances)
    if len(points) == 0 or len(np.unique(points)) < len(points):
        raise ValueError(f"points must be at least one vertex, without repetitions, got {points.tolist()}")
    weights = _checked_weights(weights, len(points), len(tolerances))
    detected = np.unique(_vertex_ids(mesh, detected, "detected"))
    distances = geodesics(mesh).distances(points, _distance_limits(mesh, tolerances).max())[:, detected]
    found = _nearest_detection(distances, weights)[:, None] <= _distance_limits(mesh, tolerances)
    count = found.sum(axis=0)
    return {
        "fne": 1 - count / len(points),
        "fpe": 1 - count / len(detected) if len(detected) else np.zeros(len(tolerances)),
        "wme": 1 - (weights * found).sum(axis=0) / weights.sum(axis=0),
    }


def _nearest_detection(distances, weights):
    """(g,) distance of each point to the nearest detected vertex without a nearer point; infinite if there is none."""
    heavy = np.argsort(-weights.sum(axis=1), kind="stable")
    owner = heavy[np.argmin(distances[heavy], axis=0)]
    owned = owner == np.arange(len(distances))[:, None]
    return np.where(owned, distances, np.inf).min(axis=1, initial=np.inf)


def _distance_limits(mesh, tolerances):
    """(t,) tolerances in units of the mesh; slightly more, so that rounding does not matter at multiples of an edge."""
    return tolerances * mesh.diagonal * (1 + 1e-9)


def _vertex_ids(mesh, ids, name):
    ids = np.asarray(ids)
    if ids.size == 0:
        return np.zeros(0, dtype=np.int64)
    if ids.ndim != 1 or ids.dtype.kind not in "iu" or ids.min() < 0 or ids.max() >= len(mesh.vertices):
        raise ValueError(f"{name} must be vertex ids in 0..{len(mesh.vertices) - 1}, shape (k,), got {ids}")
    return ids.astype(np.int64)


def _checked_tolerances(tolerances):
    values = np.asarray(tolerances, dtype=np.float64)
    if values.ndim != 1 or len(values) == 0 or not np.isfinite(values).all() or values.min() < 0:
        raise ValueError(f"tolerances must be shares of the diagonal, 0 or more, shape (t,), got {values}")
    return values


def _checked_weights(weights, count, steps):
    values = np.ones(count) if weights is None else np.asarray(weights, dtype=np.float64)
    if values.shape not in ((count,), (count, steps)):
        raise ValueError(f"weights must have shape ({count},) or ({count}, {steps}), got {values.shape}")
    values = np.broadcast_to(values.reshape(count, -1), (count, steps))
    if not np.isfinite(values).all() or (values < 0).any() or not values.any(axis=0).all():
        raise ValueError("weights must be finite, not negative and not all zero at any tolerance")
    return values
