"""Agreement of a saliency with people: metrics at the vertices, errors of interest points."""

from .interest_points import TOLERANCES, gaze_peaks, interest_point_errors
from .metrics import METRICS, GroundTruth, agreement, auc, cc, kl, nss, sim

__all__ = [
    "GroundTruth", "METRICS", "TOLERANCES", "agreement", "auc", "cc", "gaze_peaks", "interest_point_errors", "kl",
    "nss", "sim",
]  # fmt: skip
