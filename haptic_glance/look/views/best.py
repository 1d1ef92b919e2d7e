"""The best viewpoints of a mesh, and the surface that a set of viewpoints sees (T3.2.4).

The thesis gives 18 sets of four perpendicular viewpoints. Ten of the 72 are shared, so that 62 are distinct. It shows
them around an object (T figure 3.14a), but does not state the arrangement, which is derived here. There are six great
circles through the poles, 30 degrees apart, with twelve positions each, also 30 degrees apart. These twelve form
three squares, which start at 0, 30 and 60 degrees above the horizon: 6 x 3 = 18 sets. Each circle has one square with
both poles, so each pole is in six sets and 2 x 5 = 10 of the 72 are repeated. The 62 that remain are five parallels of
twelve viewpoints, and the two poles. T3.3.2 arranges its 218 viewpoints in the same way: nine parallels with a
viewpoint every 15 degrees, and the poles. The four principal views of T3.1.2 (+-z and +-y) are one of the sets.

Visibility is tested by exact rays at points spread over the surface. For the 62 candidates this takes 0.15 s at 10,000
faces and 0.3 s at 40,000. Reading face ids off rendered images of 225 x 300 pixels takes three times as long and is
less accurate: faces that are thin, small or seen at a grazing angle fall between pixels, up to a fifth of the surface
that a view sees.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene
from haptic_glance.mesh.sampling import sample_surface

from ..camera import Viewpoint
from .cover import find_cover
from .viewpoints import scaled_to_unit_diagonal, sightlines

RAYS = 10  # per view; T3.2.4
FACES = 2  # a ray through a convex body meets two faces; more mean surface hidden from both sides; T3.2.4
DRAWS = 1000  # positions in the bounding rectangle of a view; the first RAYS of them on the object count
OFFSET = 1e-5  # of the diagonal: where a ray continues behind a face; above single precision, below any wall thickness
DIGITS = 12  # relative levels of sets that agree to so many digits are equal: they differ by rounding


def best_viewpoints(mesh: Mesh, level: Callable[[Viewpoint], float], seed: int = 0) -> list[Viewpoint]:
    """The best set of viewpoints of a mesh: a list of four to eight Viewpoints (T3.2.4).

    The first four stand perpendicular around one axis (PERPENDICULAR_SETS). The added views follow: for each of the
    four with hidden surface (hidden_surface), the view at 45 degrees between it and the next one of the set. The best
    set has the highest average level, its added views included; of equal sets, the first is returned.

    level: a function of a Viewpoint that returns its level of saliency, the sum over the pixels of the saliency map
    (T eq. 3.10). It is called for each of the 62 candidates and for each added view that a set needs, at most 72
    times. seed: of the random rays. Raises ValueError for a mesh without area and for a level that is not finite.

    T3.2.4 first describes views added to the best four, then an average over a set with its complementary views. The
    average is implemented, since the section calls its maximum the best set.
    """
    has_hidden = dict(zip(CANDIDATES, hidden_surface(mesh, CANDIDATES, seed), strict=True))
    sets = []
    for views, between in zip(PERPENDICULAR_SETS, BETWEEN, strict=True):
        added = [extra for view, extra in zip(views, between, strict=True) if has_hidden[view]]
        sets.append([*views, *added])
    distinct = dict.fromkeys(view for views in sets for view in views)
    levels = {view: _finite(level(view), view) for view in distinct}
    means = np.array([np.mean([levels[view] for view in views]) for views in sets])
    scale = np.abs(means).max()
    return sets[int(np.argmax(np.round(means / scale, DIGITS)))] if scale > 0 else sets[0]


def hidden_surface(mesh: Mesh, viewpoints: Sequence[Viewpoint], seed: int = 0) -> np.ndarray:
    """(v,) boolean: one of ten random rays of the viewpoint meets more than two faces (T3.2.4, T figure 3.14b).

    Such a ray passes surface that neither this view nor the opposite one can see. The rays are parallel to the view
    axis, through positions drawn uniformly over the silhouette of the object. Coincident faces count as one, and so
    do the two faces at an edge that a ray hits. Ten rays are few: they miss hidden surface behind a small part. Raises
    ValueError for a mesh without area.
    """
    surface = scaled_to_unit_diagonal(mesh)
    scene = RayScene(surface)
    return np.array(
        [_has_hidden_surface(scene, view, rng(seed, f"rays {view.name}")) for view in viewpoints], dtype=bool
    )


def _has_hidden_surface(scene, viewpoint, random):
    """Whether one of RAYS rays through the silhouette meets more than FACES faces."""
    right_up = viewpoint.axes[:2]
    corners = scene.mesh.vertices[scene.mesh.used] @ right_up.T
    places = corners.min(axis=0) + random.random((DRAWS, 2)) * np.ptp(corners, axis=0)
    origins, directions, _ = sightlines(places @ right_up, viewpoint)
    ray_ids = np.flatnonzero(scene.cast(origins, directions).hit)[:RAYS]
    return bool((_faces_met(scene, origins[ray_ids], directions[ray_ids]) > FACES).any())


def _faces_met(scene, origins, directions):
    """(k,) i8: the number of faces that each ray meets in turn, at most FACES + 1."""
    count = np.zeros(len(origins), dtype=np.int64)
    last = np.full(len(origins), -1)
    for _ in range(FACES + 1):
        hits = scene.cast(origins, directions)
        count += hits.hit & (hits.face != last)
        last = hits.face
        origins = origins + np.where(hits.hit, hits.distance + OFFSET, 0)[:, None] * directions
    return count


def _finite(level, viewpoint):
    """The level as a float; ValueError unless it is one finite number."""
    if np.ndim(level) or not np.isfinite(level):
        raise ValueError(f"the level of saliency at {viewpoint.name} must be one finite number, got {level}")
    return float(level)


STEP = 30  # degrees between neighbours on a circle, and between circles
QUARTER = 90  # degrees between the views of a set


def on_circle(azimuth: float, angle: float) -> Viewpoint:
    """The Viewpoint `angle` degrees along the great circle from the horizon at `azimuth` through the pole.

    Images stay upright: beyond a pole the elevation decreases and the azimuth is the opposite one. At a pole the
    azimuth is 0 for every circle, so that each pole is one viewpoint.
    """
    angle = (angle + 180) % 360 - 180
    if abs(angle) > 90:
        azimuth, angle = azimuth + 180, (180 if angle > 0 else -180) - angle
    return Viewpoint(0 if abs(angle) == 90 else azimuth % 360, angle)


def _squares(shift):
    """18 tuples of four viewpoints, `shift` degrees further along the circle than those of the perpendicular sets."""
    return tuple(
        tuple(on_circle(azimuth, start + shift + QUARTER * k) for k in range(4))
        for azimuth in range(0, 180, STEP)
        for start in range(0, QUARTER, STEP)
    )


PERPENDICULAR_SETS = _squares(0)  # each in order along its circle
BETWEEN = _squares(
    QUARTER // 2
)  # BETWEEN[i][k] stands half-way from PERPENDICULAR_SETS[i][k] to the next view of set i
CANDIDATES = tuple(dict.fromkeys(viewpoint for views in PERPENDICULAR_SETS for viewpoint in views))


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
