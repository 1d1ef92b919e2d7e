"""The set of four perpendicular viewpoints that shows most saliency, with views of what it cannot see (T3.2.4)."""

import numpy as np

from stages.kit import RayScene
from stages.kit.rng import rng

from .candidates import BETWEEN, CANDIDATES, SETS
from .sightlines import sightlines, unit_surface

RAYS = 10  # a view; T3.2.4
FACES = 2  # a ray into and out of a body meets two faces; more tell of a surface hidden from both sides; T3.2.4
DRAWS = 1000  # places in the bounding rectangle of a view; the first RAYS of them on the object count
PAST = 1e-5  # of the diagonal: so far behind a face its ray goes on; above single precision, below any wall
DIGITS = 12  # levels of sets closer than this share are equal: only the order of a sum tells them apart


def best_viewpoints(mesh, level, seed=0):
    """The best set of viewpoints of a mesh: a list of four to eight Viewpoints (T3.2.4).

    The first four stand perpendicular around one axis (stages.views.SETS). After them come the added views: for each
    of the four with hidden surface (hidden_surface), the one at 45 degrees between it and the next of the set. The
    set with the highest average level, its added views included, wins; of equal ones the first.

    level: a function of a Viewpoint that returns its level of saliency, the sum over the pixels of the saliency map
    (T eq. 3.10). It is called once for each of the 62 candidates and once for each added view that some set needs,
    72 at most. seed draws the rays. Raises ValueError for a mesh without area and for a level that is not finite.

    T3.2.4 first tells of views added to the best four, then of an average over a set with its complementary views.
    The average is followed, as it is the one that the section calls the best set.
    """
    hidden = dict(zip(CANDIDATES, hidden_surface(mesh, CANDIDATES, seed), strict=True))
    sets = []
    for views, between in zip(SETS, BETWEEN, strict=True):
        added = [extra for view, extra in zip(views, between, strict=True) if hidden[view]]
        sets.append([*views, *added])
    distinct = dict.fromkeys(view for views in sets for view in views)
    levels = {view: _finite(level(view), view) for view in distinct}
    means = np.array([np.mean([levels[view] for view in views]) for views in sets])
    scale = np.abs(means).max()
    return sets[int(np.argmax(np.round(means / scale, DIGITS)))] if scale > 0 else sets[0]


def hidden_surface(mesh, viewpoints, seed=0):
    """(v,) boolean: one of ten random rays of the viewpoint meets more than two faces (T3.2.4, T figure 3.14b).

    Such a ray passes surface that neither this view nor the opposite one can see. The rays run parallel to the view
    axis, as all of an orthographic camera do, through places drawn uniformly over the object's silhouette: a ray
    beside the object would tell nothing. Faces that coincide count once, and so does a ray through the edge of two
    faces. Ten rays are few: they miss hidden surface behind a small part. Raises ValueError for a mesh without area.
    """
    surface = unit_surface(mesh)
    scene = RayScene(surface)
    return np.array([_meets_more(scene, view, rng(seed, f"rays {view.name}")) for view in viewpoints], dtype=bool)


def _meets_more(scene, viewpoint, random):
    """Whether one of RAYS rays through the silhouette meets more than FACES faces."""
    right_up = viewpoint.axes[:2]
    corners = scene.mesh.vertices[np.unique(scene.mesh.faces)] @ right_up.T
    places = corners.min(axis=0) + random.random((DRAWS, 2)) * np.ptp(corners, axis=0)
    origins, directions, _ = sightlines(places @ right_up, viewpoint)
    on = np.flatnonzero(scene.cast(origins, directions).hit)[:RAYS]
    return bool((_faces_met(scene, origins[on], directions[on]) > FACES).any())


def _faces_met(scene, origins, directions):
    """(k,) i8: how many faces each ray meets one after the other; FACES + 1 stands for all above."""
    count = np.zeros(len(origins), dtype=np.int64)
    last = np.full(len(origins), -1)
    for _ in range(FACES + 1):
        hits = scene.cast(origins, directions)
        count += hits.hit & (hits.face != last)
        last = hits.face
        origins = origins + np.where(hits.hit, hits.distance + PAST, 0)[:, None] * directions
    return count


def _finite(level, viewpoint):
    """The level as a float; ValueError when it is none."""
    if np.ndim(level) or not np.isfinite(level):
        raise ValueError(f"the level of saliency at {viewpoint.name} must be one finite number, got {level}")
    return float(level)
