"""Whether the most salient place is the same from all sides (T figure 3.29)."""

from itertools import combinations

import numpy as np

from stages.kit.rng import rng
from stages.report.figures.figure_3_30 import VIEWS
from stages.report.results import NotRun
from stages.report.style import label
from stages.report.tables._fixation import PERCENT, stored, stored_networks

TASK = "level_3"
PLACES = 2000  # random places of a view; their mean distance is then known to one per cent


def same_place(control):
    """differences(results): how much nearer the maxima of two views lie than other places that they see, in %.

    The maps of level 3 of each frozen network on this run's objects, the mean over the pairs of views that see any of
    the surface. control(mesh, seen (n,), viewpoint): (k, 3) the other places of a view.
    """

    def differences(results):
        gains = [_nearer(results, name, control) for name in results.choose([], len(results.objects), "fixation")]
        gains = [gain for gain in gains if gain is not None]
        if not gains:
            raise NotRun(f"no maps of {label(TASK)} by a frozen network", "fixation", runnable=False)
        return PERCENT * np.array(gains)

    return differences


def _nearer(results, name, control):
    """One object's distance of the other places minus that of the maxima, in units; None without maps to compare."""
    arrays, mesh = stored(results, name), results.mesh(name)
    looks = [arrays.get(f"{method}.{TASK}.views") for method in stored_networks(arrays) if method.endswith("-frozen")]
    looks = [look for look in looks if look is not None]
    views = [view for view, seen in enumerate(arrays["visible"]) if mesh.vertex_areas[seen].any()]
    if not looks or len(views) < 2:
        return None
    others = apart([control(mesh, arrays["visible"][view], VIEWS[view]) for view in views])
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
