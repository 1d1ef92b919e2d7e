"""The best viewpoints of a mesh, from 18 sets of four perpendicular ones (T3.2.4).

The thesis gives 18 sets of four perpendicular viewpoints. Ten of the 72 are shared, so that 62 are distinct. It shows
them around an object (T figure 3.14a), but does not state the arrangement, which is derived here. There are six great
circles through the poles, 30 degrees apart, with twelve positions each, also 30 degrees apart. These twelve form
three squares, which start at 0, 30 and 60 degrees above the horizon: 6 x 3 = 18 sets. Each circle has one square with
both poles, so each pole is in six sets and 2 x 5 = 10 of the 72 are repeated. The 62 that remain are five parallels of
twelve viewpoints, and the two poles. T3.3.2 arranges its 218 viewpoints in the same way: nine parallels with a
viewpoint every 15 degrees, and the poles. The four principal views of T3.1.2 (+-z and +-y) are one of the sets.
"""

from collections.abc import Callable, Sequence

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene

from ..camera import Viewpoint
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
