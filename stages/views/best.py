"""The set of four perpendicular viewpoints with the highest saliency, and views of what it cannot see (T3.2.4)."""

from collections.abc import Callable, Sequence

import numpy as np

from stages.kit import Mesh, RayScene, Viewpoint
from stages.kit.rng import rng

from .candidates import BETWEEN, CANDIDATES, PERPENDICULAR_SETS
from .sightlines import scaled_to_unit_diagonal, sightlines

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
    hidden = dict(zip(CANDIDATES, hidden_surface(mesh, CANDIDATES, seed), strict=True))
    sets = []
    for views, between in zip(PERPENDICULAR_SETS, BETWEEN, strict=True):
        added = [extra for view, extra in zip(views, between, strict=True) if hidden[view]]
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
    on = np.flatnonzero(scene.cast(origins, directions).hit)[:RAYS]
    return bool((_faces_met(scene, origins[on], directions[on]) > FACES).any())


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
