"""The surface that a set of viewpoints sees, and the few views that see much of it.

Visibility is tested by exact rays at points spread over the surface. For the 62 candidates this takes 0.15 s at 10,000
faces and 0.3 s at 40,000. Reading face ids off rendered images of 225 x 300 pixels takes three times as long and is
less accurate: faces that are thin, small or seen at a grazing angle fall between pixels, up to a fifth of the surface
that a view sees.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from haptic_glance.base.jit import cached_njit
from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene
from haptic_glance.mesh.sampling import sample_surface

from ..camera import Viewpoint
from .best import CANDIDATES
from .viewpoints import scaled_to_unit_diagonal, sightlines

POINTS = 10_000  # on the surface; the standard error of a share of 99 % is 0.1 %
SAME_DEPTH = 1e-5  # of the diagonal: depths closer than this are one surface; above single precision
ROUNDING = 1e-9  # a share this close to the target counts as attained
NODES = 10_000  # limit of the search; with 200 the numbers of the objects are the same


def surface_points(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """POINTS points spread over the surface by area, the same at every call: (points (p, 3), faces (p,) i8).

    Stratified over the cumulative area of the faces, so that each face gets its share of points to within one, and
    random within the face (Osada et al. 2002, section 3.1).
    """
    random = rng(0, "surface points")
    # A random start: with faces of equal area, regular steps would fall on the borders, where rounding decides.
    shares = (np.arange(POINTS) + random.random()) / POINTS
    points, faces, _ = sample_surface(mesh, shares, random.random((2, POINTS)))
    return points, faces


def point_visibility(mesh: Mesh, viewpoints: Sequence[Viewpoint]) -> np.ndarray:
    """(v, p) boolean: viewpoint v sees point p of surface_points(mesh); the mean of a row is the share of the area.

    mesh: of any size and position. A point is visible when nothing lies between it and the camera. Both sides of a
    face count, so a point of an open sheet is visible from either side. Raises ValueError for a mesh without area.
    """
    surface = scaled_to_unit_diagonal(mesh)
    points, _ = surface_points(surface)
    scene = RayScene(surface)
    visible = np.zeros((len(viewpoints), len(points)), dtype=bool)
    for row, viewpoint in zip(visible, viewpoints, strict=True):
        origins, directions, distances = sightlines(points, viewpoint)
        hits = scene.cast(origins, directions)
        row[:] = hits.hit & (hits.distance >= distances - SAME_DEPTH)
    return visible


def cumulative_coverage(mesh: Mesh, viewpoints: Sequence[Viewpoint]) -> np.ndarray:
    """(v,) f8 in 0..1: the share of the visible surface that the first 1, 2, ... v viewpoints see together.

    Visible surface is what at least one of the 62 candidates sees: the inside of a closed teapot does not count.
    Raises ValueError for a mesh without area.
    """
    candidates = dict(zip(CANDIDATES, _candidate_visibility(mesh), strict=True))
    visible = np.any(list(candidates.values()), axis=0)
    extras = [viewpoint for viewpoint in viewpoints if viewpoint not in candidates]
    visibility = candidates | dict(zip(extras, point_visibility(mesh, extras), strict=True))
    covered = np.logical_or.accumulate([visibility[viewpoint][visible] for viewpoint in viewpoints], axis=0)
    return covered.sum(axis=1) / max(visible.sum(), 1)


def greedy_views(mesh: Mesh, count: int = 12) -> tuple[list[Viewpoint], np.ndarray]:
    """The candidates chosen greedily by the surface that each adds: (at most `count` Viewpoints, shares (k,)).

    shares: of the visible surface, seen by the first 1, 2, ... k together. Stops early when no further candidate adds
    surface; of equal candidates the first is taken. Raises ValueError for a mesh without area or a count below one.
    """
    if count < 1:
        raise ValueError(f"count must be at least 1, got {count}")
    return _with_viewpoints(*_greedy(_visible_points(mesh), 1.0, count))


def fewest_views(mesh: Mesh, share: float = 0.99) -> tuple[list[Viewpoint], np.ndarray]:
    """The fewest of the 62 candidates that see `share` of the visible surface: (list of Viewpoint, shares (k,)).

    shares: of the visible surface, seen by the first 1, 2, ... k together, in the order of what each adds. The number
    is exact for the points of surface_points, unless the search for a smaller one needs more than NODES nodes; then it
    is the smallest one found. The greedy views are returned when they are as few. Raises ValueError for a mesh without
    area or a share outside 0..1.
    """
    if not 0 < share <= 1:
        raise ValueError(f"share must be above 0 and at most 1, got {share}")
    return _with_viewpoints(*_fewest(_visible_points(mesh), share))


@lru_cache(maxsize=2)  # several functions are called on one mesh in turn
def _candidate_visibility(mesh):
    return point_visibility(mesh, CANDIDATES)


def _visible_points(mesh):
    """(62, p') boolean: the visibility of the points that at least one candidate sees."""
    visible = _candidate_visibility(mesh)
    return visible[:, visible.any(axis=0)]


def _with_viewpoints(chosen, shares):
    return [CANDIDATES[k] for k in chosen], shares


def _greedy(seen, share, count):
    """(rows of seen in the order of what each adds (k,) i8, cumulative shares (k,))."""
    unseen = np.ones(seen.shape[1], dtype=bool)
    rows, shares = [], []
    while unseen.any() and len(rows) < count and (1 - unseen.mean()) < share - ROUNDING:
        gains = (seen & unseen).sum(axis=1)
        best = int(gains.argmax())
        unseen &= ~seen[best]
        rows.append(best)
        shares.append(1 - unseen.mean())
    return np.array(rows, dtype=np.int64), np.array(shares)


def _fewest(seen, share):
    """As few rows of seen as cover the share of its columns, greedy ones if they are: returns as _greedy does."""
    rows, shares = _greedy(seen, share, len(seen))
    # Two are optimal when the first greedy view, the best single one, was not enough.
    while len(rows) > 2 and len(fewer := _fewer(seen, share, len(rows) - 1)):
        order, shares = _greedy(seen[fewer], 1.0, len(fewer))
        rows = fewer[order]
    return rows, shares


def _fewer(seen, share, most):
    """(k,) i8: at most `most` rows of seen that cover the share of its columns; none where no rows do."""
    codes, counts = np.unique(np.packbits(seen, axis=0).T, axis=0, return_counts=True)  # points seen by the same rows
    kinds = np.unpackbits(codes, axis=1, count=len(seen)).T
    goal = float(np.ceil((share - ROUNDING) * counts.sum()))
    return find_cover(np.ascontiguousarray(kinds, dtype=np.float32), counts.astype(np.float32), goal, most, NODES)


kernel = cached_njit(fastmath=True)
# The search for few views is a branch and bound, bounded by Lagrangian relaxation.
STEPS = 25  # of the prices at a node, which start from its parent's
AIM = 0.01  # of the points: how far below the need a step of the prices aims; a longer step needs fewer nodes
MARGIN = 0.1  # points: the bound is worked out in single precision
NOTHING = np.zeros(0, dtype=np.int64)


@kernel
def find_cover(seen: np.ndarray, counts: np.ndarray, need: float, most: int, nodes: int) -> np.ndarray:
    """At most `most` views that see `need` points together, as rows of seen; none where no views do.

    seen (v, k) f4, 1 where view v sees the points of kind k, else 0; counts (k,) f4: the points of a kind. nodes: the
    search gives up after so many.

    Every point has a price of at most one, which each view that sees it earns. The r best-earning views, and what the
    prices of all points fall short of one, bound what any r views see. The bound falls when points that none of
    the best views sees become dearer and points that several see become cheaper (Fisher, The Lagrangian relaxation
    method for solving integer programming problems, Management Science 27(1), 1981).
    """
    views, total = len(seen), counts.sum()
    waiting = [(np.zeros(views, dtype=np.int8), counts.copy())]  # of each view: 1 taken, -1 left out; prices
    for _ in range(nodes):
        if not len(waiting):
            break
        state, prices = waiting.pop()
        taken, free = np.flatnonzero(state == 1), np.flatnonzero(state == 0)
        more = min(most - len(taken), len(free))
        unseen = counts * (1 - _times(seen, taken).clip(0, 1))
        best, bound = free[:0], 0.0
        for _ in range(STEPS):
            # For one view more, its gain is the bound.
            prices = np.minimum(prices, unseen) if more > 1 else unseen
            earned = np.array([_product(seen[v], prices) for v in free])
            order = np.argsort(-earned)[:more]
            best, bound = free[order], total - prices.sum() + earned[order].sum()
            surplus = _times(seen, best) - 1
            if total - _product(unseen, (surplus < 0).astype(np.float32)) >= need:
                return np.concatenate((taken, best))
            if bound < need - MARGIN or more < 2:
                break
            step = np.float32((bound - need + AIM * total) / max(_product(unseen, surplus * surplus), np.float32(1)))
            prices = np.maximum(prices - step * unseen * surplus, np.float32(0))
        if bound >= need - MARGIN and more > 1:
            for choice in (-1, 1):
                child = state.copy()
                child[best[0]] = choice
                waiting.append((child, prices))
    return NOTHING


@kernel
def _times(seen, views):
    """(k,) f4: how many of the views see each kind of points."""
    times = np.zeros(seen.shape[1], dtype=np.float32)
    for v in views:
        times += seen[v]
    return times


@kernel
def _product(a, b):
    total = np.float32(0)
    for k in range(len(a)):
        total += a[k] * b[k]
    return total
