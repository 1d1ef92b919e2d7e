"""Metrics of the agreement of a saliency with people: AUC, CC, KL, NSS and SIM over the surface."""

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
        for name, quantity in (
            ("areas", self.areas),
            ("amounts", self.amounts),
            ("density", self.density * self.areas),
        ):
            if not quantity.any():
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


def auc(saliency: np.ndarray, truth: GroundTruth) -> float:
    """The probability that a fixation, drawn by amount, has higher saliency than a point drawn evenly on the surface.

    Equal values count half. In 0..1; chance, and a constant saliency, is 0.5. Only the order of the values matters. As
    in AUC-Judd (Bylinskii et al., PAMI 2019, section 4.1) the threshold takes all values at fixations. Judd's negatives
    exclude the fixated pixels, and on a mesh the area of these would depend on the resolution. Here the whole surface
    is negative, by area: the limit of AUC-Borji for many random points. Therefore 1 is not attainable while fixations
    cover any area. Exact: ranks by one sort, ties by trapezoids. Raises ValueError for a saliency of another shape or
    with NaN.
    """
    _, level = np.unique(checked_saliency(saliency, truth), return_inverse=True)
    positives = np.bincount(level, weights=truth.amounts) / truth.amounts.sum()
    negatives = np.bincount(level, weights=truth.shares)
    below = np.cumsum(negatives) - negatives / 2
    return float(np.clip(positives @ below, 0.0, 1.0))


def cc(saliency: np.ndarray, truth: GroundTruth) -> float:
    """Pearson's correlation of saliency (n,) and truth.density over the surface, each vertex weighted by its area.

    In -1..1, 1 is best; 0 when either is constant. Unlike KL it is symmetric in over- and underestimation. Source:
    Bylinskii, Judd, Oliva, Torralba and Durand, What do different evaluation metrics tell us about saliency models?,
    PAMI 2019, section 4.2. Raises ValueError for a saliency of another shape or with NaN.
    """
    predicted = standardised(checked_saliency(saliency, truth), truth.shares)
    density = np.ldexp(truth.density, -np.frexp(truth.density.max())[1])  # in any unit; a power of two loses no digit
    return float(truth.shares @ (predicted * standardised(density, truth.shares)))


EPSILON = np.finfo(np.float64).eps  # 2.2e-16, as in the benchmark: keeps the logarithm of zero finite


def kl(saliency: np.ndarray, truth: GroundTruth) -> float:
    """Information lost, in nats, when saliency (n,) stands in for truth.density, both as distributions over the area.

    0 for equal distributions, without upper bound. A constant saliency, including zero, counts as uniform attention.
    Zeros where people looked cost most: 36 nats plus the logarithm of the density there over its mean. Source:
    Bylinskii et al., PAMI 2019, section 4.2. They add epsilon to the share of a pixel; here it is added to the density
    over its mean, which unlike the share of a vertex does not depend on the resolution of the mesh. Raises ValueError
    for a saliency of another shape, with NaN or with negative values.
    """
    predicted = as_density(checked_saliency(saliency, truth), truth.shares, "saliency")
    observed = as_density(truth.density, truth.shares, "density")
    divergence = truth.shares @ (observed * np.log(EPSILON + observed / (predicted + EPSILON)))
    return float(max(divergence, 0.0))  # rounding leaves -1e-16 for equal distributions


def nss(saliency: np.ndarray, truth: GroundTruth) -> float:
    """Mean over the fixations of saliency (n,) in standard deviations above its mean over the area.

    Fixations are weighted by their amount (seconds of gaze or counts). Chance, and a constant saliency, is 0; there is
    no upper bound. Source: Peters, Iyer, Itti and Koch, Components of bottom-up gaze allocation in natural images,
    Vision Research 2005; Bylinskii et al., PAMI 2019, section 4.1. Raises ValueError for a saliency of another shape or
    with NaN.
    """
    predicted = standardised(checked_saliency(saliency, truth), truth.shares)
    return float(truth.amounts @ predicted / truth.amounts.sum())


def sim(saliency: np.ndarray, truth: GroundTruth) -> float:
    """The share of attention that saliency (n,) and truth.density put at the same places, both as distributions.

    In 0..1, 1 for equal distributions. A constant saliency, including zero, counts as uniform attention. A map that is
    too concentrated loses more than one that is too spread out. Source: Bylinskii et al., PAMI 2019, section 4.2; their
    code also moves each map's minimum to zero, which the definition does not ask for. Raises ValueError for a saliency
    of another shape, with NaN or with negative values.
    """
    predicted = as_density(checked_saliency(saliency, truth), truth.shares, "saliency")
    observed = as_density(truth.density, truth.shares, "density")
    return float(truth.shares @ np.minimum(predicted, observed))


METRICS = {"cc": cc, "nss": nss, "auc": auc, "sim": sim, "kl": kl}  # higher is better, except for kl


def agreement(saliency: np.ndarray, truth: GroundTruth) -> dict[str, float]:
    """All METRICS of a saliency (n,), not negative, against a GroundTruth: dict name -> float.

    Raises ValueError for a saliency of another shape, with NaN or with negative values.
    """
    return {name: metric(saliency, truth) for name, metric in METRICS.items()}
