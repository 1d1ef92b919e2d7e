"""Points of a surface in the order in which attention visits them: the highest value, inhibited, then the next."""

import numpy as np

FADING = 0.5  # deviation of the inhibition, in radii


def visited(points: np.ndarray, values: np.ndarray, radius: float, count: int) -> np.ndarray:
    """(k,) i8 ids of points (n, 3), most salient first by values (n,) >= 0, farther apart than the radius.

    Each visit inhibits what lies around it: nothing is left within the radius, and beyond it fades in (inhibition of
    return; Itti, Koch and Niebur, A model of saliency-based visual attention, PAMI 20(11), 1998). The next peak is then
    on its own slope, not on the rim of a disc cut out, which noise moves. At most `count`, fewer where no value above
    zero is left.
    """
    left = np.maximum(values, 0.0)
    found = []
    while len(found) < count and left.any():
        best = int(left.argmax())
        found.append(best)
        away = ((points - points[best]) ** 2).sum(axis=1) / radius**2
        left *= np.where(away <= 1, 0.0, 1 - np.exp(-away / (2 * FADING**2)))
    return np.array(found, dtype=np.int64)
