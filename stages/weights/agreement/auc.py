"""Area under the ROC curve of the saliency as a detector of fixations."""

import numpy as np

from .truth import checked


def auc(saliency, truth):
    """The chance that a fixation drawn by amount lies on higher saliency than a point drawn evenly on the surface.

    Equal values count half. 0..1, 0.5 is chance and what a constant saliency gets; only the order of the values counts.
    The variant: as in AUC-Judd (Bylinskii et al., PAMI 2019, section 4.1) the threshold runs through all values at
    fixations. Judd's negatives leave the fixated pixels out, and how much surface that is would depend on the
    meshing, so here the whole surface is the negative, by area: what AUC-Borji tends to with ever more of its random
    points, without the draw. One is therefore out of reach while fixations cover any area. Exact: ranks by one sort,
    ties by trapezoids. Raises ValueError for a saliency of another shape or with NaN.
    """
    _, level = np.unique(checked(saliency, truth), return_inverse=True)
    positives = np.bincount(level, weights=truth.amounts) / truth.amounts.sum()
    negatives = np.bincount(level, weights=truth.shares)
    below = np.cumsum(negatives) - negatives / 2
    return float(np.clip(positives @ below, 0.0, 1.0))
