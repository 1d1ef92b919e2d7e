"""What every method is given and what it returns."""

from dataclasses import dataclass, field

import numpy as np

from stages.conspicuity.surface_values import SMOOTHING
from stages.weights import Learned

from .select import select_by_centroid, select_by_suppression

RADIUS = 0.058  # units, 50 pixels at 900 rows: the width of the kernel that keeps points apart in T3.2.1.3

# How points are taken from one map (h, w), given a radius in pixels and a count.
SELECTIONS = {
    "suppression": select_by_suppression,
    "centroid": lambda image, radius, count: select_by_centroid(image, count),  # regions keep apart by themselves
}


@dataclass(frozen=True)
class Options:
    """learned: the weights of each method; radius, smoothing in units; seed and name for the draws of `random`."""

    learned: Learned = field(default_factory=Learned)
    selection: str = "suppression"
    radius: float = RADIUS
    smoothing: float = SMOOTHING
    seed: int = 0
    name: str = ""

    def __post_init__(self):
        if self.selection not in SELECTIONS:
            raise ValueError(f"unknown selection {self.selection!r}: choose one of {', '.join(SELECTIONS)}")
        if not self.radius > 0 or not self.smoothing >= 0:
            raise ValueError(f"radius must be positive, smoothing not negative, got {self.radius}, {self.smoothing}")


@dataclass(frozen=True)
class Found:
    """points (k,) i8, most salient first; strong: how many pass the threshold; saliency (n,) f8.

    strong and saliency are None where a method has no such thing.
    """

    points: np.ndarray
    strong: int | None
    saliency: np.ndarray | None
