"""Agreement of a saliency with people: metrics at the vertices, errors of interest points."""

from .auc import auc
from .cc import cc
from .gaze_peaks import gaze_peaks
from .ground_truth import GroundTruth
from .interest_points import TOLERANCES, interest_point_errors
from .kl import kl
from .metrics import METRICS, agreement
from .nss import nss
from .sim import sim

__all__ = [
    "METRICS", "TOLERANCES", "GroundTruth", "agreement", "auc", "cc", "gaze_peaks",
    "interest_point_errors", "kl", "nss", "sim",
]  # fmt: skip
