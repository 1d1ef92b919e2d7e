"""Explores an object by touch: touch, update the belief, choose the next place.

The next place is chosen by saliency, at random or by expected information gain.
"""

from dataclasses import dataclass

import numpy as np

from .belief import Calibration

# Numbers of `State.predicted` that are weighed together: the cache holds them; all would need four times their memory.
AT_ONCE = 1 << 16


def explore(
    strategy: str,
    observed: np.ndarray,
    predicted: np.ndarray,
    probabilities: np.ndarray,
    calibration: Calibration,
    max_touches: int,
    random: np.random.Generator,
) -> np.ndarray:
    """(e, max_touches, classes) log belief after each touch of e objects; strategy: a name in STRATEGIES.

    observed (e, q, classes): log likelihood of the touch at each of the q places of an object, the most salient first;
    predicted, probabilities: as in `State`; max_touches: at most q. A strategy uses `observed` only of the places that
    it has touched.
    """
    if strategy not in STRATEGIES:
        raise ValueError(f"unknown strategy {strategy!r}: choose one of {', '.join(STRATEGIES)}")
    count, places, classes = observed.shape
    if not 1 <= max_touches <= places:
        raise ValueError(
            f"max_touches must be 1 to {places}, since there are {places} places to touch, got {max_touches}"
        )
    state = State(np.zeros((count, classes)), 0, random.random((count, places)), predicted, probabilities, calibration)
    untouched, rows = np.ones((count, places), dtype=bool), np.arange(count)
    beliefs = np.empty((count, max_touches, classes))
    for touch in range(max_touches):
        place = np.where(untouched, STRATEGIES[strategy](state), -np.inf).argmax(axis=1)
        untouched[rows, place] = False
        state.log_likelihoods, state.touches = state.log_likelihoods + observed[rows, place], touch + 1
        beliefs[:, touch] = calibration.log_belief(state.log_likelihoods, state.touches)
    return beliefs


def stop(beliefs: np.ndarray, truth: np.ndarray, confidence: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The end of explorations that stop at a confidence: (touches (e,), belief (e,), correct (e,) boolean).

    beliefs (e, max_touches, classes): log beliefs as `explore` gives them; truth (e,). belief is that in the likeliest
    object after the last touch. It is below `confidence` if all touches did not suffice.
    """
    best = np.exp(beliefs.max(axis=2))
    is_confident = best >= confidence
    last_index = np.where(is_confident.any(axis=1), is_confident.argmax(axis=1), beliefs.shape[1] - 1)
    rows = np.arange(len(beliefs))
    return last_index + 1, best[rows, last_index], beliefs[rows, last_index].argmax(axis=1) == truth


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
    belief = np.exp(state.calibration.log_belief(state.log_likelihoods, max(state.touches, 1)))
    scores = np.empty(state.random_scores.shape)
    step = max(1, AT_ONCE * len(scores[0]) // max(1, state.predicted.size))
    for first in range(0, len(scores[0]), step):
        places = slice(first, first + step)
        likelihoods = state.log_likelihoods[:, None, None, None] + state.predicted[:, places]
        log_after = state.calibration.log_belief(likelihoods, state.touches + 1)
        entropy = -np.einsum("eqcoj,eqcoj->eqco", np.exp(log_after), log_after)
        scores[:, places] = -np.einsum("eqco,eqco,ec->eq", entropy, state.probabilities[:, places], belief)
    return scores


STRATEGIES = {"saliency": by_saliency, "random": at_random, "gain": by_gain}
