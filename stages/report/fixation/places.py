"""Whether the most salient place is the same from all sides (T figure 3.29)."""

from itertools import combinations

import numpy as np
import pandas as pd

from stages.kit.rng import rng
from stages.report.differences import statistic
from stages.report.results import NotRun
from stages.report.style import label

from .rows import VIEWPOINTS, stored, stored_networks

TASK = "level_3"
PLACES = 2000  # random places of a view; their mean distance is then known to one per cent


@statistic("nearer_than_chance")
def nearer_than_chance(results, claim):
    """How much nearer the maxima of two views lie than random places that they see, per object, in units."""
    return _nearer(results, anywhere)


@statistic("nearer_than_middle")
def nearer_than_middle(results, claim):
    """How much nearer the maxima of two views lie than what they show in the middle, per object, in units."""
    return _nearer(results, middle)


def _nearer(results, control):
    """Series over objects: level 3 of each frozen network, the mean over the pairs of views that see any surface.

    control(mesh, seen (n,), viewpoint): (k, 3) the other places of a view.
    """
    gains = pd.Series(
        {name: _gain(results, name, control) for name in results.choose([], len(results.objects), "fixation")}
    )
    if gains.isna().all():
        raise NotRun(f"no maps of {label(TASK)} by a frozen network", "fixation", runnable=False)
    return gains


def _gain(results, name, control):
    """One object's distance of the other places minus that of the maxima; NaN without maps to compare."""
    arrays, mesh = stored(results, name), results.mesh(name)
    looks = [arrays.get(f"{method}.{TASK}.views") for method in stored_networks(arrays) if method.endswith("-frozen")]
    looks = [look for look in looks if look is not None]
    views = [view for view, seen in enumerate(arrays["visible"]) if mesh.vertex_areas[seen].any()]
    if not looks or len(views) < 2:
        return np.nan
    others = apart([control(mesh, arrays["visible"][view], VIEWPOINTS[view]) for view in views])
    return others - np.mean([apart([top(mesh, arrays["visible"][k], look[k]) for k in views]) for look in looks])


def top(mesh, seen, values):
    """(1, 3): the most salient place of a view, of those that it sees."""
    masked = np.where(seen, values.astype(float), -1)
    return mesh.vertices[masked == masked.max()].mean(axis=0, keepdims=True)  # half precision has ties


def anywhere(mesh, seen, viewpoint):
    """(PLACES, 3): random places on the surface that a view sees."""
    shares = np.where(seen, mesh.vertex_areas, 0)
    return mesh.vertices[rng(0, viewpoint.name).choice(len(seen), PLACES, p=shares / shares.sum())]


def middle(mesh, seen, viewpoint):
    """(1, 3): what a view shows in the middle of the picture."""
    aside = np.linalg.norm(mesh.vertices @ viewpoint.axes[:2].T, axis=1)
    return mesh.vertices[[np.where(seen, aside, np.inf).argmin()]]


def apart(places):
    """The mean distance between the places (k, 3) of two views, over the pairs of views."""
    return float(np.mean([np.linalg.norm(a - b, axis=1).mean() for a, b in combinations(places, 2)]))
