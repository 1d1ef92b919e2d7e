"""How much of a surface a set of viewpoints sees, and the fewest that see nearly all of it.

Visibility is tested by exact rays at points spread over the surface: 0.15 s for the 62 candidates at 10,000 faces and
0.3 s at 40,000. Reading the faces' numbers off rendered images of 225 x 300 pixels takes three times as long and tells
less: faces that are thin, small or seen at a grazing angle fall between pixels, up to a fifth of what a view sees.
"""

from functools import lru_cache

import numpy as np
from scipy import sparse
from scipy.optimize import Bounds, LinearConstraint, milp

from stages.kit import RayScene
from stages.kit.rng import rng

from .candidates import CANDIDATES
from .sightlines import sightlines, unit_surface

POINTS = 10_000  # on the surface; the standard error of a share of 99 % is 0.1 %
SAME_DEPTH = 1e-5  # of the diagonal: nearer than this two depths are one surface; above single precision
ROUNDING = 1e-9  # a share this close to the one asked for has reached it
NODES = 100  # of HiGHS's search tree; objects took 1 to 17, and no object shall hold up the others


def surface_points(mesh):
    """POINTS points spread over the surface by area, always the same: (points (p, 3), faces (p,) i8).

    Evenly over the faces' running area, so each face gets its share of points to within one; random within the face
    (Osada et al. 2002, section 3.1).
    """
    random = rng(0, "surface points")
    total = np.cumsum(mesh.face_areas)
    # A random start, since faces of equal area would put round steps on their borders, where rounding decides.
    at = (np.arange(POINTS) + random.random()) / POINTS * total[-1]
    faces = np.searchsorted(total, at, side="right").clip(max=len(total) - 1)
    first, second = random.random((2, POINTS))
    root = np.sqrt(first)
    weights = np.stack([1 - root, root * (1 - second), root * second], axis=1)
    return np.einsum("pk,pkd->pd", weights, mesh.vertices[mesh.faces[faces]]), faces


def coverage(mesh, viewpoints):
    """(v, p) boolean: viewpoint v sees point p of surface_points(mesh); the mean of a row is the share of the area.

    mesh of any size and place; viewpoints: v of kit.Viewpoint. A point is seen when nothing lies between it and the
    camera. Either side of a face counts: of an open sheet the same place is seen from both sides. Raises ValueError
    for a mesh without area.
    """
    surface = unit_surface(mesh)
    points, _ = surface_points(surface)
    scene = RayScene(surface)
    seen = np.zeros((len(viewpoints), len(points)), dtype=bool)
    for row, viewpoint in zip(seen, viewpoints, strict=True):
        origins, directions, distances = sightlines(points, viewpoint)
        hits = scene.cast(origins, directions)
        row[:] = hits.hit & (hits.distance >= distances - SAME_DEPTH)
    return seen


def seen_shares(mesh, viewpoints):
    """(v,) f8 in 0..1: the share of the visible surface that the first 1, 2, ... v viewpoints see together.

    Visible is what one of the 62 candidates sees: the inside of a closed teapot does not count. ValueError for a mesh
    without area.
    """
    visible = _candidate_coverage(mesh).any(axis=0)
    seen = np.logical_or.accumulate(coverage(mesh, viewpoints)[:, visible], axis=0)
    return seen.sum(axis=1) / max(visible.sum(), 1)


def greedy_views(mesh, count=12):
    """The candidates in the order of what each adds to those before it: (list of at most `count`, shares as above).

    Ends early when no further candidate adds anything; the first of equal ones is taken. ValueError for a mesh
    without area or a count below one.
    """
    if count < 1:
        raise ValueError(f"count must be at least 1, got {count}")
    return _named(*_greedy(_visible_part(mesh), 1.0, count))


def fewest_views(mesh, share=0.99):
    """The fewest of the 62 candidates that see `share` of the visible surface: (list of Viewpoint, shares (k,)).

    shares: of the visible surface, seen by the first 1, 2, ... k, in the order of what each adds. The number is exact
    for the points of surface_points, by mixed-integer programming (scipy.optimize.milp, HiGHS), unless that needs more
    than NODES nodes: then it is the smallest found. The greedy views are taken where they are as few. This costs
    seconds, where greedy_views costs milliseconds. ValueError for a mesh without area or a share outside 0..1.
    """
    if not 0 < share <= 1:
        raise ValueError(f"share must lie above 0 and not above 1, got {share}")
    seen = _visible_part(mesh)
    chosen, shares = _greedy(seen, share, len(seen))
    if len(chosen) > 2:  # two are as few as can be when greed's first view, the best single one, was not enough
        exact = _exact(seen, share)
        if len(exact) < len(chosen):
            order, shares = _greedy(seen[exact], 1.0, len(exact))
            chosen = exact[order]
    return _named(chosen, shares)


@lru_cache(maxsize=2)  # the questions about one mesh follow each other
def _candidate_coverage(mesh):
    return coverage(mesh, CANDIDATES)


def _visible_part(mesh):
    """(62, p') boolean: the columns of the candidates' coverage that any of them sees."""
    seen = _candidate_coverage(mesh)
    return seen[:, seen.any(axis=0)]


def _named(chosen, shares):
    return [CANDIDATES[k] for k in chosen], shares


def _greedy(seen, share, count):
    """(rows of seen in the order of what each adds (k,) i8, shares seen so far (k,))."""
    left = np.ones(seen.shape[1], dtype=bool)
    chosen, shares = [], []
    while left.any() and len(chosen) < count and (1 - left.mean()) < share - ROUNDING:
        gains = (seen & left).sum(axis=1)
        best = int(gains.argmax())
        left &= ~seen[best]
        chosen.append(best)
        shares.append(1 - left.mean())
    return np.array(chosen, dtype=np.int64), np.array(shares)


def _exact(seen, share):
    """(k,) i8: fewest rows of seen that cover the share of its columns, by integer programming; all if none is found.

    Unknowns: which rows are taken, and which kinds of points are covered, points seen by the same rows being one kind.
    """
    packed, counts = np.unique(np.packbits(seen, axis=0).T, axis=0, return_counts=True)
    kinds = np.unpackbits(packed, axis=1, count=len(seen))
    rows, k = len(seen), len(kinds)
    covered = sparse.hstack([sparse.csr_matrix(kinds, dtype=float), -sparse.eye(k)]).tocsr()
    enough = sparse.csr_matrix(np.r_[np.zeros(rows), counts / counts.sum()][None])
    is_row = np.r_[np.ones(rows), np.zeros(k)]
    limits = [LinearConstraint(covered, lb=0), LinearConstraint(enough, lb=share - ROUNDING)]
    solved = milp(is_row, integrality=is_row, bounds=Bounds(0, 1), constraints=limits, options={"node_limit": NODES})
    return np.arange(rows) if solved.x is None else np.flatnonzero(solved.x[:rows] > 0.5)
