"""Linear correlation of the predicted saliency with the human density."""

import numpy as np

from .ground_truth import GroundTruth, checked_saliency, standardised


def cc(saliency: np.ndarray, truth: GroundTruth) -> float:
    """Pearson's correlation of saliency (n,) and truth.density over the surface, each vertex weighted by its area.

    In -1..1, 1 is best; 0 when either is constant. Unlike KL it is symmetric in over- and underestimation. Source:
    Bylinskii, Judd, Oliva, Torralba and Durand, What do different evaluation metrics tell us about saliency models?,
    PAMI 2019, section 4.2. Raises ValueError for a saliency of another shape or with NaN.
    """
    predicted = standardised(checked_saliency(saliency, truth), truth.shares)
    return float(truth.shares @ (predicted * standardised(truth.density, truth.shares)))
