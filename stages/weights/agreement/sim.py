"""Similarity, the histogram intersection of the predicted and the human distribution over the surface."""

import numpy as np

from .ground_truth import GroundTruth, as_density, checked_saliency


def sim(saliency: np.ndarray, truth: GroundTruth) -> float:
    """The share of attention that saliency (n,) and truth.density put at the same places, both as distributions.

    In 0..1, 1 for equal distributions. A constant saliency, including zero, counts as uniform attention. A map that is
    too concentrated loses more than one that is too spread out. Source: Bylinskii et al., PAMI 2019, section 4.2; their
    code also moves each map's minimum to zero, which the definition does not ask for. Raises ValueError for a saliency
    of another shape, with NaN or with negative values.
    """
    predicted = as_density(checked_saliency(saliency, truth), truth.shares, "saliency")
    seen = as_density(truth.density, truth.shares, "density")
    return float(truth.shares @ np.minimum(predicted, seen))
