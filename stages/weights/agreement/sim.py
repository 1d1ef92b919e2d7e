"""Similarity, the histogram intersection of the predicted and the human distribution over the surface."""

import numpy as np

from .truth import as_density, checked


def sim(saliency, truth):
    """The share of attention that saliency (n,) and truth.density put at the same places, both as distributions.

    0..1, one for equal distributions; a constant saliency, zero included, counts as even attention. A map that spreads
    too little loses more than one that spreads too much. Source: Bylinskii et al., PAMI 2019, section 4.2; their code
    also moves each map's minimum to zero, which the definition does not ask for. Raises ValueError for a saliency of
    another shape, with NaN or with negative values.
    """
    predicted = as_density(checked(saliency, truth), truth.shares, "saliency")
    seen = as_density(truth.density, truth.shares, "density")
    return float(truth.shares @ np.minimum(predicted, seen))
