"""How much of a surface a set of viewpoints sees, and the fewest viewpoints that see nearly all of it.

Visibility is tested by exact rays at points spread over the surface. For the 62 candidates this takes 0.15 s at 10,000
faces and 0.3 s at 40,000. Reading face ids off rendered images of 225 x 300 pixels takes three times as long and is
less accurate: faces that are thin, small or seen at a grazing angle fall between pixels, up to a fifth of the surface
that a view sees.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from stages.kit import Mesh, RayScene, Viewpoint
from stages.kit.rng import rng
from stages.kit.surface_samples import sample_surface

from .candidates import CANDIDATES
from .kernels import find_cover
from .sightlines import scaled_to_unit_diagonal, sightlines

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
    seen = np.zeros((len(viewpoints), len(points)), dtype=bool)
    for row, viewpoint in zip(seen, viewpoints, strict=True):
        origins, directions, distances = sightlines(points, viewpoint)
        hits = scene.cast(origins, directions)
        row[:] = hits.hit & (hits.distance >= distances - SAME_DEPTH)
    return seen


def cumulative_coverage(mesh: Mesh, viewpoints: Sequence[Viewpoint]) -> np.ndarray:
    """(v,) f8 in 0..1: the share of the visible surface that the first 1, 2, ... v viewpoints see together.

    Visible surface is what at least one of the 62 candidates sees: the inside of a closed teapot does not count.
    Raises ValueError for a mesh without area.
    """
    candidates = dict(zip(CANDIDATES, _candidate_visibility(mesh), strict=True))
    visible = np.any(list(candidates.values()), axis=0)
    others = [viewpoint for viewpoint in viewpoints if viewpoint not in candidates]
    known = candidates | dict(zip(others, point_visibility(mesh, others), strict=True))
    seen = np.logical_or.accumulate([known[viewpoint][visible] for viewpoint in viewpoints], axis=0)
    return seen.sum(axis=1) / max(visible.sum(), 1)


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
    seen = _candidate_visibility(mesh)
    return seen[:, seen.any(axis=0)]


def _with_viewpoints(chosen, shares):
    return [CANDIDATES[k] for k in chosen], shares


def _greedy(seen, share, count):
    """(rows of seen in the order of what each adds (k,) i8, cumulative shares (k,))."""
    left = np.ones(seen.shape[1], dtype=bool)
    chosen, shares = [], []
    while left.any() and len(chosen) < count and (1 - left.mean()) < share - ROUNDING:
        gains = (seen & left).sum(axis=1)
        best = int(gains.argmax())
        left &= ~seen[best]
        chosen.append(best)
        shares.append(1 - left.mean())
    return np.array(chosen, dtype=np.int64), np.array(shares)


def _fewest(seen, share):
    """As few rows of seen as cover the share of its columns, greedy ones if they are: returns as _greedy does."""
    chosen, shares = _greedy(seen, share, len(seen))
    # Two are optimal when the first greedy view, the best single one, was not enough.
    while len(chosen) > 2 and len(fewer := _fewer(seen, share, len(chosen) - 1)):
        order, shares = _greedy(seen[fewer], 1.0, len(fewer))
        chosen = fewer[order]
    return chosen, shares


def _fewer(seen, share, most):
    """(k,) i8: at most `most` rows of seen that cover the share of its columns; none where no rows do."""
    packed, counts = np.unique(np.packbits(seen, axis=0).T, axis=0, return_counts=True)  # points seen by the same rows
    kinds = np.unpackbits(packed, axis=1, count=len(seen)).T
    need = float(np.ceil((share - ROUNDING) * counts.sum()))
    return find_cover(np.ascontiguousarray(kinds, dtype=np.float32), counts.astype(np.float32), need, most, NODES)
