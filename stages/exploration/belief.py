"""The belief over the objects after some touches, such that a stated 95 % is right 95 times in a hundred."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize
from scipy.special import log_softmax


@dataclass(frozen=True)
class Calibration:
    """How much touches count: all logarithms of likelihoods are summed and multiplied by weight * touches^-sharing.

    weight is the inverse temperature of one touch (Guo and others, On calibration of modern neural networks, 2017).
    sharing is what touches of one object have in common: 0 where they are independent, so that evidence adds up as in
    naive Bayes; 1 where a second touch says nothing that the first did not.
    """

    weight: float
    sharing: float

    def log_belief(self, summed, touches):
        """Log belief (..., classes) after `touches` touches with summed log likelihoods (..., classes)."""
        factor = self.weight * np.asarray(touches, dtype=np.float64) ** -self.sharing
        return log_softmax(np.asarray(factor)[..., None] * summed, axis=-1)


def calibrate(sequences, truth, sharing=True):
    """The Calibration under which the true objects of sequences of touches are likeliest.

    sequences (e, touches, classes): log likelihoods of touches, in the order of touching; truth (e,). All lengths of a
    sequence count alike. The touches must be of places that the likelihood was not made from. sharing=False keeps
    `sharing` at 0 and fits the weight to single touches: the plain product.
    """
    summed = np.cumsum(sequences if sharing else sequences[:, :1], axis=1)
    touches = np.arange(1, summed.shape[1] + 1)

    def loss(values):
        log_belief = Calibration(np.exp(values[0]), values[1]).log_belief(summed, touches)
        return -log_belief[np.arange(len(truth)), :, truth].mean()

    bounds = [(-4.0, 3.0), (0.0, 1.0 if sharing else 0.0)]
    found = minimize(loss, [0.0, 0.5 if sharing else 0.0], bounds=bounds, method="L-BFGS-B").x
    return Calibration(float(np.exp(found[0])), float(found[1]))
