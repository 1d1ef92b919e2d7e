"""Whether the most salient place of an object is the same from all sides (T figure 3.29), beside other places."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.look.camera import Viewpoint
from haptic_glance.mesh.mesh import Mesh

ITSELF = "level_3"  # the task to name the object itself
PLACES = 2000  # random places of a view; their mean distance is then known to one per cent


def nearer(mesh: Mesh, viewpoints: Sequence[Viewpoint], seen: np.ndarray, values: np.ndarray) -> dict[str, float]:
    """How much nearer the maxima of a map in two views lie than other places, in units: the mean over pairs of views.

    seen (v, n) boolean and values (v, n): what each view sees, and the map at the vertices there. dict metric ->
    value: `nearer_than_chance` beside random places on the surface that the views see, `nearer_than_middle` beside
    what they show in the middle of the picture. Views that see nothing are left out; empty where one or none is left.
    """
    views = [view for view, mask in enumerate(seen) if mesh.vertex_areas[mask].any()]
    if len(views) < 2:
        return {}
    tops = _apart([_top(mesh, seen[view], values[view]) for view in views])
    return {
        f"nearer_than_{name}": _apart([control(mesh, seen[view], viewpoints[view]) for view in views]) - tops
        for name, control in (("chance", _anywhere), ("middle", _middle))
    }


def _top(mesh: Mesh, seen: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(1, 3): the most salient place of a view, of those that it sees."""
    masked = np.where(seen, values.astype(float), -1)
    return mesh.vertices[masked == masked.max()].mean(axis=0)[None]  # half precision has ties


def _anywhere(mesh: Mesh, seen: np.ndarray, viewpoint: Viewpoint) -> np.ndarray:
    """(PLACES, 3): random places on the surface that a view sees."""
    shares = np.where(seen, mesh.vertex_areas, 0)
    return mesh.vertices[rng(0, viewpoint.name).choice(len(seen), PLACES, p=shares / shares.sum())]


def _middle(mesh: Mesh, seen: np.ndarray, viewpoint: Viewpoint) -> np.ndarray:
    """(1, 3): what a view shows in the middle of the picture."""
    aside = np.linalg.norm(mesh.vertices @ viewpoint.axes[:2].T, axis=1)
    return mesh.vertices[[np.where(seen, aside, np.inf).argmin()]]


def _apart(places: Sequence[np.ndarray]) -> float:
    """The mean distance between the places (k, 3) of two views, over the pairs of views."""
    return float(np.mean([np.linalg.norm(a - b, axis=1).mean() for a, b in combinations(places, 2)]))
