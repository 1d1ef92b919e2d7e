"""Where people looked on a surface, and the two ways of scaling a map that the agreement metrics share."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

FLAT = 1e-12  # spread over the largest value; below it a map is constant and its spread is rounding


@dataclass(frozen=True, eq=False)
class Truth:
    """Human attention on a mesh of n vertices, in the order of its vertices.

    amounts (n,): the raw fixations, as seconds of gaze or counts, at the vertices that were hit. density (n,): the same
    spread over the surface, per unit of area, in any unit. areas (n,): the surface that each vertex stands for, in any
    unit; 0 for a vertex in no face. Every metric weighs a vertex by its area, so that no result depends on how finely
    a place is meshed. Raises ValueError for arrays that disagree, hold NaN or negative values, or are all zero.
    """

    amounts: np.ndarray
    density: np.ndarray
    areas: np.ndarray

    def __post_init__(self):
        for name in ("areas", "amounts", "density"):
            values = np.asarray(getattr(self, name), dtype=np.float64)
            if values.ndim != 1 or values.shape != np.shape(self.areas):
                raise ValueError(f"{name} must have shape (n,), one a vertex like areas, got {values.shape}")
            if not np.isfinite(values).all() or (values < 0).any():
                raise ValueError(f"{name} must be finite and not negative: set missing values to 0")
            object.__setattr__(self, name, values)
        for name, seen in (("areas", self.areas), ("amounts", self.amounts), ("density", self.density * self.areas)):
            if not seen.any():
                raise ValueError(f"the truth is empty, {name} is zero on the whole surface: leave this mesh out")

    @cached_property
    def shares(self):
        """(n,) the share of the whole surface at each vertex; they sum to one."""
        return self.areas / self.areas.sum()


def checked(saliency, truth):
    """The saliency as (n,) f8, scaled so that its largest magnitude is one: no metric depends on its unit."""
    values = np.asarray(saliency, dtype=np.float64)
    if values.shape != truth.areas.shape:
        raise ValueError(f"saliency must have shape {truth.areas.shape}, one value a vertex, got {values.shape}")
    if not np.isfinite(values).all():
        raise ValueError("saliency holds NaN or infinite values: a method without an answer gives 0 everywhere")
    return values / (np.abs(values).max() or 1.0)


def standardised(values, shares):
    """Values (n,) less their mean, over their standard deviation, both over area; zero where they are constant."""
    centred = values - shares @ values
    spread = np.sqrt(shares @ centred**2)
    if spread <= FLAT * np.abs(values).max():
        return np.zeros_like(values)
    return centred / spread


def as_density(values, shares, name):
    """Values (n,) scaled to mean one over the area: one is what even attention would give. Zeros count as even."""
    if (values < 0).any():
        raise ValueError(f"{name} is negative in places, so it is no density: subtract its minimum first")
    mean = shares @ values
    return values / mean if mean > 0 else np.ones_like(values)
