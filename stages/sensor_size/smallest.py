"""The smallest sensor that is enough, and how far that choice is to be trusted."""

import numpy as np

RESAMPLES = 1000  # of the objects: a share of them is then known within three points


def smallest_enough(accuracy, slack):
    """Key (cells, pitch) of the smallest array whose accuracy lacks at most `slack` of the best one's.

    accuracy: {(cells a side, pitch): mean accuracy}. Smallest is fewest sensels, since each is wired and read; of
    equally many, the narrower array, since it fits into more places. ValueError for no array or a negative slack.
    """
    if not accuracy or not slack >= 0:
        raise ValueError(f"give at least one array and a slack of 0 or more, got {len(accuracy)} and {slack}")
    floor = max(accuracy.values()) - slack
    return min(key for key, value in accuracy.items() if value >= floor)


def chosen_again(scores, slack, seed=0):
    """The share of bootstrap resamples of the objects in which `smallest_enough` chooses the same array.

    scores: {(cells a side, pitch): accuracies of the objects, in one order}. The arrays lie closer together than their
    intervals are wide: without this the smallest one would pass for a finding where it is chance.
    """
    table = np.array(list(scores.values()), dtype=np.float64)
    chosen = smallest_enough(dict(zip(scores, table.mean(axis=1), strict=True)), slack)
    picks = np.random.default_rng(seed).integers(table.shape[1], size=(RESAMPLES, table.shape[1]))
    drawn = (dict(zip(scores, means, strict=True)) for means in table[:, picks].mean(axis=2).T)
    return sum(smallest_enough(means, slack) == chosen for means in drawn) / RESAMPLES
