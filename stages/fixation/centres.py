"""The distance between the most salient regions of a model and of human fixations (T3.3.6)."""

import numpy as np

from .subtractive import subtractive_clusters

TOP = 0.95  # of the maximum: the maximum itself is one vertex, while the thesis clusters regions of maximal saliency


def centres(vertices: np.ndarray, values: np.ndarray, seen: np.ndarray, top: float = TOP) -> np.ndarray:
    """(c, 3): the centres of the regions of maximal saliency among the seen vertices; (0, 3) for a constant map.

    top: the share of the maximum from which a vertex counts as maximal.
    """
    values, ids = np.asarray(values, dtype=np.float64)[seen], np.flatnonzero(seen)
    if not len(values) or values.max() <= max(values.min(), 0):
        return np.zeros((0, 3))
    highest = np.asarray(vertices)[ids[values >= top * values.max()]]
    return highest[subtractive_clusters(highest)]


def centre_distance(
    vertices: np.ndarray, truth: np.ndarray, values: np.ndarray, seen: np.ndarray, top: float = TOP
) -> tuple[float, float]:
    """(least, mean) distance in units between the fixation centres of the ground truth (n,) and those of values (n,).

    As in the pseudocode of T3.3.6, each centre of the ground truth, the densest first, is paired with the nearest
    centre of the saliency that is not yet paired. The thesis reports the least distance per view. The mean over the
    pairs is given too, since the least shrinks as the number of centres grows. NaN where either map is constant.
    top: as in centres; 1 is the maximum to the letter.
    """
    people, ours = centres(vertices, truth, seen, top), centres(vertices, values, seen, top)
    found = []
    for centre in people:
        if not len(ours):
            break
        distances = np.linalg.norm(ours - centre, axis=1)
        found.append(distances.min())
        ours = np.delete(ours, distances.argmin(), axis=0)
    return (float(min(found)), float(np.mean(found))) if found else (np.nan, np.nan)
