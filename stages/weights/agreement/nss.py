"""Normalised scanpath saliency: the standardised prediction at the fixations."""

import numpy as np

from .ground_truth import GroundTruth, checked_saliency, standardised


def nss(saliency: np.ndarray, truth: GroundTruth) -> float:
    """Mean over the fixations of saliency (n,) in standard deviations above its mean over the area.

    Fixations are weighted by their amount (seconds of gaze or counts). Chance, and a constant saliency, is 0; there is
    no upper bound. Source: Peters, Iyer, Itti and Koch, Components of bottom-up gaze allocation in natural images,
    Vision Research 2005; Bylinskii et al., PAMI 2019, section 4.1. Raises ValueError for a saliency of another shape or
    with NaN.
    """
    predicted = standardised(checked_saliency(saliency, truth), truth.shares)
    return float(truth.amounts @ predicted / truth.amounts.sum())
