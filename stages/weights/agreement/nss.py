"""Normalised scanpath saliency: how far above the surface's average the prediction stands where people looked."""

from .truth import checked, standardised


def nss(saliency, truth):
    """Mean over the fixations of saliency (n,) in standard deviations above its mean over the area.

    A fixation weighs its amount (seconds of gaze or counts). 0 is chance and what a constant saliency gets; there is
    no upper bound. Source: Peters, Iyer, Itti and Koch, Components of bottom-up gaze allocation in natural images,
    Vision Research 2005; Bylinskii et al., PAMI 2019, section 4.1. Raises ValueError for a saliency of another shape or
    with NaN.
    """
    predicted = standardised(checked(saliency, truth), truth.shares)
    return float(truth.amounts @ predicted / truth.amounts.sum())
