"""All metrics of the agreement of a saliency with people, by name."""

import numpy as np

from .auc import auc
from .cc import cc
from .ground_truth import GroundTruth
from .kl import kl
from .nss import nss
from .sim import sim

METRICS = {"cc": cc, "nss": nss, "auc": auc, "sim": sim, "kl": kl}  # higher is better, except for kl


def agreement(saliency: np.ndarray, truth: GroundTruth) -> dict[str, float]:
    """All METRICS of a saliency (n,), not negative, against a GroundTruth: dict name -> float.

    Raises ValueError for a saliency of another shape, with NaN or with negative values.
    """
    return {name: metric(saliency, truth) for name, metric in METRICS.items()}
