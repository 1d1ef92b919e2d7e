"""Whether the most salient place is the same from all sides (T figure 3.29)."""

from collections.abc import Callable, Sequence
from functools import partial
from itertools import combinations

import numpy as np
import pandas as pd

from stages.kit import Mesh, Viewpoint
from stages.kit.rng import rng
from stages.report.claims import Claim
from stages.report.differences import statistic
from stages.report.results import Results, some
from stages.report.style import label

from .rows import VIEWPOINTS, stored

ITSELF = "level_3"  # the task to name the object itself
PLACES = 2000  # random places of a view; their mean distance is then known to one per cent
Control = Callable[[Mesh, np.ndarray, Viewpoint], np.ndarray]  # (mesh, seen (n,), viewpoint) -> (k, 3) other places


def nearer(control: Control, results: Results, claim: Claim | None = None) -> pd.Series:
    """How much nearer the maxima of level 3 in two views lie than other places, in units; by object, over the pairs."""
    names = results.choose([], len(results.objects), "fixation")
    gains = pd.Series({name: _gain(stored(results, name), results.mesh(name), control) for name in names})
    return some(gains.dropna(), f"no maps of {label(ITSELF)} by a frozen network", "fixation", runnable=False)


def _gain(arrays: dict[str, np.ndarray], mesh: Mesh, control: Control) -> float:
    """One object's distance of the other places minus that of the maxima; NaN without maps to compare."""
    looks = [views for key, views in arrays.items() if key.endswith(f"-frozen.{ITSELF}.views")]
    seen = arrays["visible"]
    views = [view for view, mask in enumerate(seen) if mesh.vertex_areas[mask].any()]
    if not looks or len(views) < 2:
        return np.nan
    tops = [np.vstack([_top(mesh, seen[view], look[view]) for look in looks]) for view in views]
    return _apart([control(mesh, seen[view], VIEWPOINTS[view]) for view in views]) - _apart(tops)


def _top(mesh: Mesh, seen: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(3,): the most salient place of a view, of those that it sees."""
    masked = np.where(seen, values.astype(float), -1)
    return mesh.vertices[masked == masked.max()].mean(axis=0)  # half precision has ties


def anywhere(mesh: Mesh, seen: np.ndarray, viewpoint: Viewpoint) -> np.ndarray:
    """(PLACES, 3): random places on the surface that a view sees."""
    shares = np.where(seen, mesh.vertex_areas, 0)
    return mesh.vertices[rng(0, viewpoint.name).choice(len(seen), PLACES, p=shares / shares.sum())]


def middle(mesh: Mesh, seen: np.ndarray, viewpoint: Viewpoint) -> np.ndarray:
    """(1, 3): what a view shows in the middle of the picture."""
    aside = np.linalg.norm(mesh.vertices @ viewpoint.axes[:2].T, axis=1)
    return mesh.vertices[[np.where(seen, aside, np.inf).argmin()]]


def _apart(places: Sequence[np.ndarray]) -> float:
    """The mean distance between the places (k, 3) of two views, over the pairs of views."""
    return float(np.mean([np.linalg.norm(a - b, axis=1).mean() for a, b in combinations(places, 2)]))


statistic("nearer_than_chance")(partial(nearer, anywhere))
statistic("nearer_than_middle")(partial(nearer, middle))
