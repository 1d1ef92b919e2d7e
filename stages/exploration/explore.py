"""Explorations side by side: touch, update the belief, choose the next place."""

import numpy as np

from .choose import WAYS, State


def explore(way, felt, foreseen, chances, calibration, most, random):
    """(e, most, classes) log belief after each touch of e objects, with the places chosen by a name in WAYS.

    felt (e, q, classes): log likelihood of what each of the q places of an object really feels like, most salient
    first; foreseen, chances: as in `State`; calibration: see `belief`; most: touches, at most q; random: a generator.
    The way sees of `felt` only what was touched.
    """
    count, places, classes = felt.shape
    if not 1 <= most <= places:
        raise ValueError(f"most must be 1 to the {places} places that there are to touch, got {most}")
    state = State(np.zeros((count, classes)), 0, random.random((count, places)), foreseen, chances, calibration)
    left, rows = np.ones((count, places), dtype=bool), np.arange(count)
    beliefs = np.empty((count, most, classes))
    for touch in range(most):
        place = np.where(left, WAYS[way](state), -np.inf).argmax(axis=1)
        left[rows, place] = False
        state.summed, state.touches = state.summed + felt[rows, place], touch + 1
        beliefs[:, touch] = calibration.log_belief(state.summed, state.touches)
    return beliefs


def stop(beliefs, truth, confidence):
    """How explorations end that stop at a confidence: (touches (e,), belief (e,), right (e,) boolean).

    beliefs (e, most, classes): log beliefs as `explore` gives them; truth (e,). belief is that in the likeliest object
    after the last touch; below `confidence` where even the last touch did not suffice.
    """
    best = np.exp(beliefs.max(axis=2))
    enough = best >= confidence
    last = np.where(enough.any(axis=1), enough.argmax(axis=1), beliefs.shape[1] - 1)
    rows = np.arange(len(beliefs))
    return last + 1, best[rows, last], beliefs[rows, last].argmax(axis=1) == truth
