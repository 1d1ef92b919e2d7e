"""Explorations side by side: touch, update the belief, choose the next place."""

import numpy as np

from .belief import Calibration
from .choose import STRATEGIES, State


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
    reached = best >= confidence
    last_index = np.where(reached.any(axis=1), reached.argmax(axis=1), beliefs.shape[1] - 1)
    rows = np.arange(len(beliefs))
    return last_index + 1, best[rows, last_index], beliefs[rows, last_index].argmax(axis=1) == truth
