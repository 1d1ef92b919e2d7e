"""The fusion of two senses, and their calibration (beyond T5.5, whose network gets one sense at a time).

All functions take and return numpy arrays. A row of NaN is an absent sense; the other one then decides alone.
"""

from typing import Any

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.special import log_softmax, softmax

LOG_HOTTEST = np.log(100)  # temperatures are searched between 1 and 100


def probabilities(scores: np.ndarray, temperature: float = 1.0) -> np.ndarray:
    """(n, k) f8: the softmax of scores (n, k) over a temperature; above 1 it lowers the confidence of the network."""
    if not temperature > 0:
        raise ValueError(f"a temperature must be above 0, got {temperature}")
    return softmax(np.asarray(scores, dtype=np.float64) / temperature, axis=1)


def best_temperature(scores: np.ndarray, labels: np.ndarray) -> float:
    """The temperature under which the labels (n,) are most likely (Guo et al. 2017, On calibration of neural networks).

    scores (n, k) must be of items that the network was not trained on. A temperature never changes the predicted class.
    It is at least 1: where all of a few items are right, lower temperatures would always be more likely, and the
    network would be trusted even without evidence. Raises ValueError for no items, or scores that are not finite.
    """
    scores, labels = np.asarray(scores, dtype=np.float64), np.asarray(labels)
    if not len(scores) or len(scores) != len(labels) or not np.isfinite(scores).all():
        raise ValueError(f"a temperature needs finite scores with their labels, got {scores.shape} and {labels.shape}")

    def negative_log_likelihood(logarithm):
        return -log_softmax(scores / np.exp(logarithm), axis=1)[np.arange(len(labels)), labels].mean()

    optimum: Any = minimize_scalar(negative_log_likelihood, bounds=(0, LOG_HOTTEST), method="bounded")
    return float(np.exp(optimum.x))


def certainty(distribution: np.ndarray) -> np.ndarray:
    """(n,) in 0..1: one minus the normalised entropy; 1 where one class has all probability, 0 where all are equal."""
    logs = np.log(distribution, out=np.zeros_like(distribution), where=distribution > 0)
    return 1 + (distribution * logs).sum(axis=1) / np.log(distribution.shape[1])


def mean(vision: np.ndarray, touch: np.ndarray) -> np.ndarray:
    """The mean of both senses."""
    return (vision + touch) / 2


def product(vision: np.ndarray, touch: np.ndarray) -> np.ndarray:
    """The product of both senses, as for independent errors and equally frequent classes."""
    joint = np.clip(vision, 1e-12, None) * np.clip(touch, 1e-12, None)
    return joint / joint.sum(axis=1, keepdims=True)


def entropy(vision: np.ndarray, touch: np.ndarray) -> np.ndarray:
    """The mean of both senses, weighted by their certainty."""
    weights = np.stack([certainty(vision), certainty(touch)]) + 1e-12  # two senses without certainty get equal weights
    weights = (weights / weights.sum(axis=0))[..., None]
    return weights[0] * vision + weights[1] * touch


def most_confident(vision: np.ndarray, touch: np.ndarray) -> np.ndarray:
    """The sense with the higher maximal probability, of equals vision, as in HybridNet.predict."""
    return np.where((vision.max(axis=1) >= touch.max(axis=1))[:, None], vision, touch)


FUSIONS = {"mean": mean, "product": product, "entropy": entropy, "surest": most_confident}


def fuse(vision: np.ndarray, touch: np.ndarray, rule: str) -> np.ndarray:
    """(n, k) f8: the probabilities (n, k) of both senses fused by one of FUSIONS.

    Where one sense is absent (NaN) those of the other, where both are NaN. Raises ValueError for an unknown rule or
    shapes that differ.
    """
    if rule not in FUSIONS:
        raise ValueError(f"unknown fusion {rule!r}, known: {', '.join(FUSIONS)}")
    vision, touch = np.asarray(vision, dtype=np.float64), np.asarray(touch, dtype=np.float64)
    if vision.shape != touch.shape or vision.ndim != 2:
        raise ValueError(f"both senses need probabilities of one shape (n, k), got {vision.shape} and {touch.shape}")
    fused = np.where(np.isnan(vision), touch, vision)
    both = ~np.isnan(vision).any(axis=1) & ~np.isnan(touch).any(axis=1)
    fused[both] = FUSIONS[rule](vision[both], touch[both])
    return fused


def accuracy(distribution: np.ndarray, labels: np.ndarray) -> float:
    """The share of rows whose most probable class is right; a row of NaN counts as wrong."""
    answered = np.isfinite(distribution).all(axis=1)
    return float((answered & (np.nan_to_num(distribution).argmax(axis=1) == np.asarray(labels))).mean())
