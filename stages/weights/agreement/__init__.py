"""How well a saliency agrees with people: metrics at the vertices, errors of interest points, intervals over meshes."""

from .auc import auc
from .cc import cc
from .interest_points import TOLERANCES, interest_point_errors, people_near
from .intervals import mean_interval, paired
from .kl import kl
from .nss import nss
from .sim import sim
from .truth import Truth
from .truth_points import truth_points

METRICS = {"cc": cc, "nss": nss, "auc": auc, "sim": sim, "kl": kl}  # all but kl: more is better


def agreement(saliency, truth):
    """Every metric of METRICS of saliency (n,), not negative, against a Truth: dict name -> float.

    Raises ValueError for a saliency of another shape, with NaN or with negative values.
    """
    return {name: metric(saliency, truth) for name, metric in METRICS.items()}


__all__ = [
    "METRICS", "TOLERANCES", "Truth", "agreement", "auc", "cc", "interest_point_errors", "kl", "mean_interval", "nss",
    "paired", "people_near", "sim", "truth_points",
]  # fmt: skip
