"""Calibrated belief over the objects after some touches: of beliefs of 95 %, 95 in a hundred are correct."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize
from scipy.special import log_softmax


@dataclass(frozen=True)
class Calibration:
    """The weight of touches: the sum of their log likelihoods is multiplied by weight * touches^-redundancy.

    weight is the inverse temperature of one touch (Guo and others, On calibration of modern neural networks, 2017).
    redundancy is what touches of one object have in common: 0 if they are independent, so that evidence adds up as in
    naive Bayes; 1 if a second touch adds no information.
    """

    weight: float
    redundancy: float

    def log_belief(self, log_likelihoods: np.ndarray, touches: ArrayLike) -> np.ndarray:
        """Log belief (..., classes) after `touches` touches with the summed log_likelihoods (..., classes)."""
        factor = self.weight * np.asarray(touches, dtype=np.float64) ** -self.redundancy
        return log_softmax(np.asarray(factor)[..., None] * log_likelihoods, axis=-1)


def calibrate(sequences: ArrayLike, truth: ArrayLike, redundancy: bool = True) -> Calibration:
    """The Calibration that maximises the likelihood of the true objects of sequences of touches.

    sequences (e, touches, classes): log likelihoods of touches, in the order of touching; truth (e,). All lengths of a
    sequence have equal weight. The touches must not be among those that the likelihood was fitted to. redundancy=False
    keeps the redundancy at 0 and fits the weight to single touches: the plain product.
    Raises ValueError for sequences that are empty or not finite, and for a truth that is no class of theirs.
    """
    sequences, truth = _checked(np.asarray(sequences, dtype=np.float64), np.asarray(truth))
    log_likelihoods = np.cumsum(sequences if redundancy else sequences[:, :1], axis=1)
    touches = np.arange(1, log_likelihoods.shape[1] + 1)

    def loss(values):
        log_belief = Calibration(np.exp(values[0]), values[1]).log_belief(log_likelihoods, touches)
        return -log_belief[np.arange(len(truth)), :, truth].mean()

    bounds = [(-4.0, 3.0), (0.0, 1.0 if redundancy else 0.0)]
    found = minimize(loss, [0.0, 0.5 if redundancy else 0.0], bounds=bounds, method="L-BFGS-B").x
    return Calibration(float(np.exp(found[0])), float(found[1]))


def _checked(sequences, truth):
    """The two as they are; ValueError where no touch, or no number, would calibrate a belief."""
    if sequences.ndim != 3 or 0 in sequences.shape:
        shape = "(sequences, touches, classes), of each at least one"
        raise ValueError(f"sequences must have shape {shape}, got shape {sequences.shape}")
    if len(wrong := np.argwhere(~np.isfinite(sequences))):
        value, where = sequences[tuple(wrong[0])], wrong[0][0]
        raise ValueError(f"sequences must be finite log likelihoods, got {value} in sequence {where}")
    if truth.shape != sequences.shape[:1] or not np.isin(truth, np.arange(sequences.shape[2])).all():
        remedy = f"one class from 0 to {sequences.shape[2] - 1} for each of the {len(sequences)} sequences"
        raise ValueError(f"truth must hold {remedy}")
    return sequences, truth.astype(np.int64)
