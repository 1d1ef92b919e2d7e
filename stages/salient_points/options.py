"""What every method receives and returns."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol, runtime_checkable

import numpy as np

from stages.conspicuity.surface_values import SMOOTHING
from stages.kit import Mesh
from stages.weights import LearnedWeights

from .select import SelectedPixels, select_by_centroid, select_by_suppression

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
        if not self.radius > 0 or not self.smoothing >= 0:
            raise ValueError(f"radius must be positive, smoothing not negative, got {self.radius}, {self.smoothing}")


@dataclass(frozen=True)
class Detection:
    """points (k,) i8, most salient first; strong: how many pass the threshold; saliency (n,) f8.

    strong is None for a method without a threshold, saliency for one that only places points. `detect` adds scores
    (k,) f8, those of `scores_of`, and ties (k,) i8: points with the same number have the same score within 2 %, so
    that none of them is the better one; it is the rank, from 0, of the first of them. On a sphere, a box or two equal
    parts their order is only a convention: higher ones first, then those farther from the middle.
    """

    points: np.ndarray
    strong: int | None
    saliency: np.ndarray | None
    scores: np.ndarray | None = None
    ties: np.ndarray | None = None


class Detector(Protocol):
    """An entry of METHODS; see stages.salient_points.methods."""

    @property
    def channels(self) -> tuple[str, ...]: ...

    @property
    def required_weights(self) -> str | None: ...

    # sight: a ViewMaps, or None where the method has no channels
    def find(self, mesh: Mesh, sight: Any, options: Options, count: int | None = None, /) -> Detection: ...


@runtime_checkable
class HasSaliency(Protocol):
    """A Detector that gives each vertex a saliency: all but those that only place points."""

    def saliency(self, mesh: Mesh, sight: Any, options: Options, /) -> np.ndarray: ...
