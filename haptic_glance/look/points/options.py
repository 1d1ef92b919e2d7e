"""Options and results of every detector, and the order in which attention visits places.

Attention visits the highest value, inhibits its neighbourhood, and visits the next.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol, runtime_checkable

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from ..channels.surface import SMOOTHING
from ..rivals.maxima import rounded
from ..weights import LearnedWeights
from .fuse import SelectedPixels, select_by_centroid, select_by_suppression

RADIUS = 0.058  # units, 50 pixels at 900 rows: the width of the kernel that keeps points apart in T3.2.1.3

# How points are selected from one map (h, w), given a radius in pixels and a count.
SELECTIONS: dict[str, Callable[[np.ndarray, float, int | None], SelectedPixels]] = {
    "suppression": select_by_suppression,
    "centroid": lambda image, radius, count: select_by_centroid(image, count),  # separate regions need no radius
}


@dataclass(frozen=True)
class Options:
    """learned: the weights of each method; radius, smoothing in units; seed and name for the draws of `random`."""

    learned: LearnedWeights = field(default_factory=LearnedWeights)
    selection: str = "suppression"
    radius: float = RADIUS
    smoothing: float = SMOOTHING
    seed: int = 0
    name: str = ""

    def __post_init__(self) -> None:
        if self.selection not in SELECTIONS:
            raise ValueError(f"unknown selection {self.selection!r}: choose one of {', '.join(SELECTIONS)}")
        if not (0 < self.radius < np.inf and 0 <= self.smoothing < np.inf):
            rule = "radius must be positive, smoothing not negative, both finite"
            raise ValueError(f"{rule}, got {self.radius}, {self.smoothing}")


@dataclass(frozen=True)
class Detection:
    """Salient points of a mesh, with their scores and the saliency of all vertices.

    Attributes
    ----------
    points : (k,) array of int
        Vertex ids, most salient first.
    strong : int or None
        Number of points past the method's threshold; None for a method without a threshold.
    saliency : (n,) array of float or None
        Saliency of each vertex in 0..1; None for a method that only places points.
    scores : (k,) array of float or None
        Scores of the points, see `haptic_glance.look.points.find.scores_of`; set by `detect`.
    ties : (k,) array of int or None
        Rank, from 0, of the first point whose score is the same within 2 %; set by `detect`. Points with one number are
        equally good. On a sphere, a box or two equal parts their order is a convention: higher points first, then
        points farther from the middle.
    """

    points: np.ndarray
    strong: int | None
    saliency: np.ndarray | None
    scores: np.ndarray | None = None
    ties: np.ndarray | None = None


class Detector(Protocol):
    """An entry of METHODS; see haptic_glance.look.points.methods."""

    @property
    def channels(self) -> tuple[str, ...]: ...

    @property
    def required_weights(self) -> str | None: ...

    # view_maps: a ViewMaps, or None where the method has no channels
    def find(self, mesh: Mesh, view_maps: Any, options: Options, count: int | None = None, /) -> Detection: ...


@runtime_checkable
class HasSaliency(Protocol):
    """A Detector that gives each vertex a saliency: all but those that only place points."""

    def saliency(self, mesh: Mesh, view_maps: Any, options: Options, /) -> np.ndarray: ...


FADING = 0.5  # deviation of the inhibition, in radii
DIGITS = 6  # of coordinates: smaller differences are rounding
ROUNDING = 1e-9  # of a value
TIE = 0.02  # of a value: how far below it another one counts as equal, since noise may have made it lower


def visited(points: np.ndarray, values: np.ndarray, radius: float, count: int) -> np.ndarray:
    """(k,) i8 ids of points (n, 3), most salient first by values (n,) >= 0, farther apart than the radius.

    Each visit inhibits what lies around it: nothing is left within the radius, and beyond it fades in (inhibition of
    return; Itti, Koch and Niebur, A model of saliency-based visual attention, PAMI 20(11), 1998). The next peak is then
    on its own slope, not on the rim of a disc cut out, which noise moves. At most `count`, fewer where no value above
    zero is left.
    """
    remaining, places = np.maximum(values, 0.0), rounded(points)
    visits, strength = [], []
    while len(visits) < count and remaining.any():
        equal = np.flatnonzero(remaining >= (1 - ROUNDING) * remaining.max())
        best = equal[np.lexsort(places[equal].T[::-1])[-1]]  # as `local_maxima` chooses
        visits.append(best)
        strength.append(remaining[best])
        square_distances = ((points - points[best]) ** 2).sum(axis=1) / radius**2
        remaining *= np.where(square_distances <= 1, 0.0, 1 - np.exp(-square_distances / (2 * FADING**2)))
    order, ids = tied(np.array(strength)), np.array(visits, dtype=np.int64)
    return ids[by_place(order, points[ids])]


def tied(values: np.ndarray) -> np.ndarray:
    """(k,) i8: for values (k,), largest first, the number of those that are larger by more than TIE, as far as known.

    The first value, and all that are equal to it within TIE, get 0; the next one starts another group, and so on.
    """
    groups = np.zeros(len(values), dtype=np.int64)
    for k in range(1, len(values)):
        head = values[groups[k - 1]]
        groups[k] = groups[k - 1] if values[k] >= (1 - TIE) * head else k
    return groups


def by_place(groups: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(k,) the order of points (k, 3) by group, then by height, distance from the z axis, x and y."""
    x, y, z = points.round(DIGITS).T
    return np.lexsort((-y, -x, -np.hypot(x, y).round(DIGITS), -z, groups))
