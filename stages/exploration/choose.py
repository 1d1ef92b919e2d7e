"""The choice of the next place to touch: by saliency, at random, or by expected information gain."""

from dataclasses import dataclass

import numpy as np

from .belief import Calibration


@dataclass
class State:
    """The state of e explorations of objects with q places each that can be touched, the most salient first."""

    log_likelihoods: np.ndarray  # (e, classes) sums over the touches so far
    touches: int
    random_scores: np.ndarray  # (e, q) random numbers, drawn before the first touch
    predicted: (
        np.ndarray
    )  # (e, q, classes, outcomes, classes) log likelihoods of possible touches, if it is this object
    probabilities: np.ndarray  # (e, q, classes, outcomes) of each outcome, if it is this object
    calibration: Calibration


def by_saliency(state: State) -> np.ndarray:
    """(e, q) scores: the most salient place first, which is the order of the points."""
    return -np.broadcast_to(np.arange(state.random_scores.shape[1], dtype=np.float64), state.random_scores.shape)


def at_random(state: State) -> np.ndarray:
    """(e, q) scores: a random order, drawn at the start."""
    return state.random_scores


def by_gain(state: State) -> np.ndarray:
    """(e, q) scores: minus the expected entropy of the belief after touching there.

    The greatest expected gain of information (Lindley, On a measure of the information provided by an experiment,
    1956). The robot knows the places, but not the object. If it were object c, the touch would be like one of the
    training touches of c near the place.
    """
    log_after = state.calibration.log_belief(
        state.log_likelihoods[:, None, None, None] + state.predicted, state.touches + 1
    )
    entropy = -np.einsum("eqcoj,eqcoj->eqco", np.exp(log_after), log_after)
    now = np.exp(state.calibration.log_belief(state.log_likelihoods, max(state.touches, 1)))
    return -np.einsum("eqco,eqco,ec->eq", entropy, state.probabilities, now)


STRATEGIES = {"saliency": by_saliency, "random": at_random, "gain": by_gain}
