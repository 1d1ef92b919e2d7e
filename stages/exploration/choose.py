"""Where to touch next: by saliency, at random, or where the belief is expected to gain most."""

from dataclasses import dataclass

import numpy as np

from .belief import Calibration


@dataclass
class State:
    """Where e explorations stand, of objects with q places each that the robot could touch, most salient first."""

    summed: np.ndarray  # (e, classes) log likelihoods of what was felt so far
    touches: int
    lots: np.ndarray  # (e, q) random numbers, drawn before the first touch
    foreseen: np.ndarray  # (e, q, classes, outcomes, classes) log likelihoods of what may be felt, by whose it may be
    chances: np.ndarray  # (e, q, classes, outcomes) how likely each outcome is, if it is that object
    calibration: Calibration


def by_saliency(state):
    """(e, q) scores: the most salient place first, which is the order of the points."""
    return -np.broadcast_to(np.arange(state.lots.shape[1], dtype=np.float64), state.lots.shape)


def at_random(state):
    """(e, q) scores: an order drawn at the start."""
    return state.lots


def by_gain(state):
    """(e, q) scores: minus the entropy of the belief that is expected after touching there.

    The greatest expected gain of information (Lindley, On a measure of the information provided by an experiment,
    1956). The robot sees the places, not whose they are: if it were object c, the touch would feel as one of the known
    touches of c near the place.
    """
    log_after = state.calibration.log_belief(state.summed[:, None, None, None] + state.foreseen, state.touches + 1)
    entropy = -np.einsum("eqcoj,eqcoj->eqco", np.exp(log_after), log_after)
    now = np.exp(state.calibration.log_belief(state.summed, max(state.touches, 1)))
    return -np.einsum("eqco,eqco,ec->eq", entropy, state.chances, now)


WAYS = {"saliency": by_saliency, "random": at_random, "gain": by_gain}
