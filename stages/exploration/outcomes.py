"""What a touch at a place may be like: the known touches near the place, of each object."""

import numpy as np

MAX_NEIGHBOURS = 8  # known touches of an object near a place, as predictions for the place
NEIGHBOUR_WIDTH = 0.08  # units, half an array: within which a known touch predicts others


def nearest_outcomes(distances: np.ndarray, owners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(outcomes (k, classes, o): ids of the touches of each object nearest to a place, their probabilities).

    distances (k, n): of k places to the known touches, in units; owners (n,): the objects of these, from 0.
    """
    of_object = [np.flatnonzero(owners == label) for label in range(int(owners.max()) + 1)]
    count = min(MAX_NEIGHBOURS, *map(len, of_object))
    outcomes = np.stack(
        [ids[np.argsort(distances[:, ids], axis=1, kind="stable")[:, :count]] for ids in of_object], axis=1
    )
    nearest = np.take_along_axis(distances[:, None], outcomes.reshape(len(distances), 1, -1), axis=2).reshape(
        outcomes.shape
    )
    weights = np.exp(-(nearest - nearest[..., :1]) / NEIGHBOUR_WIDTH)
    return outcomes, weights / weights.sum(axis=-1, keepdims=True)
