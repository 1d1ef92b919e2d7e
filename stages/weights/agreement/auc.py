"""Area under the ROC curve of the saliency as a detector of fixations."""

import numpy as np

from .ground_truth import GroundTruth, checked_saliency


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
