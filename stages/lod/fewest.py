"""The fewest faces that stay within a tolerance, found by measuring."""

from collections.abc import Callable

import numpy as np

from stages.kit import Mesh

from .feasibility import InfeasibleTarget, SimplifyError
from .metro import metro

CLOSE = 1.02  # the result has at most this many times the faces of a count that was too low


def fewest_faces(
    reference: Mesh, simplified: Callable[[int], Mesh], lowest: int, tolerance: float, seed: int = 0,
    report: Callable[[str], None] = lambda text: None,
) -> Mesh:  # fmt: skip
    """The Mesh of the fewest faces with a mean error of at most `tolerance`, a share of the diagonal.

    simplified(faces) -> Mesh. lowest: the lowest count to try. Bisection on the logarithm of the count: the error is
    monotone but for a few per cent, so that a mesh with a few per cent fewer faces may pass as well. A count without a
    sound mesh counts as too low. report(text) is called at each step. Returns the reference itself, with error 0, where
    no smaller mesh is within the tolerance. Raises ValueError for a tolerance that is negative or not finite.
    """
    if not 0 <= tolerance < np.inf:
        raise ValueError(f"the tolerance must be a share of the diagonal, 0 or more, got {tolerance}")
    best, low, high = reference, max(int(lowest), 1), len(reference.faces)
    count = low
    while count < high:
        found, value = _measured(reference, simplified, count, seed)
        report(f"{count:,} faces: " + ("no sound mesh" if found is None else f"{100 * value:.4f} %"))
        if found is not None and value <= tolerance:
            best, high = found, count
        else:
            low = count
        if high <= low or high <= CLOSE * low:
            break
        count = int(np.sqrt(low * high))
        if count in (low, high):
            break
    return best


def _measured(reference, simplified, faces, seed):
    try:
        found = simplified(faces)
    except (SimplifyError, InfeasibleTarget):
        return None, np.inf
    return found, metro(reference, found, seed=seed)["mean"]
