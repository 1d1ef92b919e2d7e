"""Agreement of a saliency with people: metrics at the vertices, errors of interest points."""

import numpy as np

from .auc import auc
from .cc import cc
from .gaze_peaks import gaze_peaks
from .ground_truth import GroundTruth
from .interest_points import TOLERANCES, interest_point_errors
from .kl import kl
from .nss import nss
from .sim import sim

METRICS = {"cc": cc, "nss": nss, "auc": auc, "sim": sim, "kl": kl}  # higher is better, except for kl


def agreement(saliency: np.ndarray, truth: GroundTruth) -> dict[str, float]:
    """All METRICS of a saliency (n,), not negative, against a GroundTruth: dict name -> float.

    Raises ValueError for a saliency of another shape, with NaN or with negative values.
    """
    return {name: metric(saliency, truth) for name, metric in METRICS.items()}


__all__ = [
    "METRICS", "TOLERANCES", "GroundTruth", "agreement", "auc", "cc", "gaze_peaks",
    "interest_point_errors", "kl", "nss", "sim",
]  # fmt: skip
