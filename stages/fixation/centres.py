"""How far what a model finds most salient lies from where people looked most (T3.3.6)."""

import numpy as np

from .subtractive import subtractive_clusters

TOP = 0.95  # of the maximum: literally the maximum is one vertex, and the thesis parts regions of maximal saliency


def centres(vertices, values, seen):
    """(c, 3): the centres of the regions of maximal saliency among the seen vertices; (0, 3) for a constant map."""
    values, ids = np.asarray(values, dtype=np.float64)[seen], np.flatnonzero(seen)
    if not len(values) or values.max() <= max(values.min(), 0):
        return np.zeros((0, 3))
    top = np.asarray(vertices)[ids[values >= TOP * values.max()]]
    return top[subtractive_clusters(top)]


def centre_distance(vertices, truth, values, seen):
    """(least, mean) distance in units between the fixation centres of the truth (n,) and those of values (n,).

    The pseudocode of T3.3.6: each centre of the truth, the densest first, is paired with the nearest centre left of the
    saliency, until either has none. The thesis registers the least for a view; the mean over the pairs is told beside
    it, since the least shrinks with the number of centres alone. NaN where the truth or the saliency is constant.
    """
    people, ours = centres(vertices, truth, seen), centres(vertices, values, seen)
    found = []
    for centre in people:
        if not len(ours):
            break
        distances = np.linalg.norm(ours - centre, axis=1)
        found.append(distances.min())
        ours = np.delete(ours, distances.argmin(), axis=0)
    return (float(min(found)), float(np.mean(found))) if found else (np.nan, np.nan)
