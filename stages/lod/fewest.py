"""The fewest faces that stay within a tolerance, found by measuring."""

import numpy as np

from .feasibility import InfeasibleTarget, SimplifyError
from .metro import metro

CLOSE = 1.02  # the answer is at most this much larger than a count that was measured to be too low


def fewest_faces(reference, simplified, lowest, tolerance, seed=0, say=lambda text: None):
    """The Mesh of the fewest faces with a mean error of at most `tolerance`, a share of the diagonal.

    simplified(faces) -> Mesh. lowest: the least count that can be asked for. Bisection on the logarithm of the count:
    the error falls with it but for a few per cent, so that a mesh some per cent smaller may pass as well. A count that
    cannot be had soundly counts as too low. say(text) hears of each step. The reference itself, with error 0, where
    nothing less is within the tolerance. ValueError for a tolerance that is negative or no number.
    """
    if not 0 <= tolerance < np.inf:
        raise ValueError(f"the tolerance must be a share of the diagonal from 0 on, got {tolerance}")
    best, low, high = reference, max(int(lowest), 1), len(reference.faces)
    asked = low
    while asked < high:
        found, value = _measured(reference, simplified, asked, seed)
        say(f"{asked:,} faces: " + ("none sound" if found is None else f"{100 * value:.4f} %"))
        if value <= tolerance:
            best, high = found, asked
        else:
            low = asked
        if high <= low or high <= CLOSE * low:
            break
        asked = int(np.sqrt(low * high))
        if asked in (low, high):
            break
    return best


def _measured(reference, simplified, faces, seed):
    try:
        found = simplified(faces)
    except (SimplifyError, InfeasibleTarget):
        return None, np.inf
    return found, metro(reference, found, seed=seed)["mean"]
