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


def calibrate(sequences: np.ndarray, truth: np.ndarray, redundancy: bool = True) -> Calibration:
    """The Calibration that maximises the likelihood of the true objects of sequences of touches.

    sequences (e, touches, classes): log likelihoods of touches, in the order of touching; truth (e,). All lengths of a
    sequence have equal weight. The touches must not be among those that the likelihood was fitted to. redundancy=False
    keeps the redundancy at 0 and fits the weight to single touches: the plain product.
    """
    log_likelihoods = np.cumsum(sequences if redundancy else sequences[:, :1], axis=1)
    touches = np.arange(1, log_likelihoods.shape[1] + 1)

    def loss(values):
        log_belief = Calibration(np.exp(values[0]), values[1]).log_belief(log_likelihoods, touches)
        return -log_belief[np.arange(len(truth)), :, truth].mean()

    bounds = [(-4.0, 3.0), (0.0, 1.0 if redundancy else 0.0)]
    found = minimize(loss, [0.0, 0.5 if redundancy else 0.0], bounds=bounds, method="L-BFGS-B").x
    return Calibration(float(np.exp(found[0])), float(found[1]))
