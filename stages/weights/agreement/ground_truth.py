"""Where people looked on a surface, and the two scalings of a map that the agreement metrics share."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

FLAT = 1e-12  # standard deviation over the largest value; below it a map is constant up to rounding


@dataclass(frozen=True, eq=False)
class GroundTruth:
    """Human attention on a mesh of n vertices, in the order of its vertices.

    amounts (n,): the raw fixations at the vertices, in seconds of gaze or counts. density (n,): the same spread over
    the surface, per unit of area, in any unit. areas (n,): the area that each vertex represents, in any unit; 0 for a
    vertex in no face. All metrics weight vertices by area, so that no result depends on the resolution of the mesh.
    Raises ValueError for arrays of different lengths, with NaN or negative values, or all zero.
    """

    amounts: np.ndarray
    density: np.ndarray
    areas: np.ndarray

    def __post_init__(self) -> None:
        for name in ("areas", "amounts", "density"):
            values = np.asarray(getattr(self, name), dtype=np.float64)
            if values.ndim != 1 or values.shape != np.shape(self.areas):
                raise ValueError(f"{name} must have shape (n,), one value per vertex like areas, got {values.shape}")
            if not np.isfinite(values).all() or (values < 0).any():
                raise ValueError(f"{name} must be finite and not negative: set missing values to 0")
            object.__setattr__(self, name, values)
        for name, seen in (("areas", self.areas), ("amounts", self.amounts), ("density", self.density * self.areas)):
            if not seen.any():
                raise ValueError(f"the ground truth is empty, {name} is zero on the whole surface: leave this mesh out")

    @cached_property
    def shares(self) -> np.ndarray:
        """(n,) the share of the whole surface at each vertex; they sum to one."""
        return self.areas / self.areas.sum()


def checked_saliency(saliency: np.ndarray, truth: GroundTruth) -> np.ndarray:
    """The saliency as (n,) f8, scaled so that its largest magnitude is one: no metric depends on its unit."""
    values = np.asarray(saliency, dtype=np.float64)
    if values.shape != truth.areas.shape:
        raise ValueError(f"saliency must have shape {truth.areas.shape}, one value per vertex, got {values.shape}")
    if not np.isfinite(values).all():
        raise ValueError("saliency holds NaN or infinite values: a method without a result must give 0 everywhere")
    return values / (np.abs(values).max() or 1.0)


def standardised(values: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """Values (n,) minus their mean, over their standard deviation, both by area; zero if they are constant."""
    centred = values - shares @ values
    spread = np.sqrt(shares @ centred**2)
    if spread <= FLAT * np.abs(values).max():
        return np.zeros_like(values)
    return centred / spread


def as_density(values: np.ndarray, shares: np.ndarray, name: str) -> np.ndarray:
    """Values (n,) scaled to a mean of one over the area, the value of uniform attention. All zeros count as uniform."""
    if (values < 0).any():
        raise ValueError(f"{name} is negative in places, so it is not a density: subtract its minimum first")
    mean = shares @ values
    return values / mean if mean > 0 else np.ones_like(values)
