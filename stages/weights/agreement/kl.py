"""Kullback-Leibler divergence of the human distribution from the predicted one."""

import numpy as np

from .ground_truth import GroundTruth, as_density, checked_saliency

EPSILON = np.finfo(np.float64).eps  # 2.2e-16, as in the benchmark: keeps the logarithm of zero finite


def kl(saliency: np.ndarray, truth: GroundTruth) -> float:
    """Information lost, in nats, when saliency (n,) stands in for truth.density, both as distributions over the area.

    0 for equal distributions, without upper bound. A constant saliency, including zero, counts as uniform attention.
    Zeros where people looked cost most, up to 36 nats times the attention there. Source: Bylinskii et al., PAMI 2019,
    section 4.2. They add epsilon to the share of a pixel; here it is added to the density over its mean, which unlike
    the share of a vertex does not depend on the resolution of the mesh. Raises ValueError for a saliency of another
    shape, with NaN or with negative values.
    """
    predicted = as_density(checked_saliency(saliency, truth), truth.shares, "saliency")
    seen = as_density(truth.density, truth.shares, "density")
    lost = truth.shares @ (seen * np.log(EPSILON + seen / (predicted + EPSILON)))
    return float(max(lost, 0.0))  # rounding leaves -1e-16 for equal distributions
