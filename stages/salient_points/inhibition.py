"""Points of a surface in the order in which attention visits them: the highest value, inhibited, then the next."""

import numpy as np

FADING = 0.5  # deviation of the inhibition, in radii
DIGITS = 6  # of coordinates: smaller differences are rounding
TIE = 0.02  # of a value: how far below it another one counts as equal, since noise may have made it lower


def visited(points: np.ndarray, values: np.ndarray, radius: float, count: int) -> np.ndarray:
    """(k,) i8 ids of points (n, 3), most salient first by values (n,) >= 0, farther apart than the radius.

    Each visit inhibits what lies around it: nothing is left within the radius, and beyond it fades in (inhibition of
    return; Itti, Koch and Niebur, A model of saliency-based visual attention, PAMI 20(11), 1998). The next peak is then
    on its own slope, not on the rim of a disc cut out, which noise moves. At most `count`, fewer where no value above
    zero is left.
    """
    left = np.maximum(values, 0.0)
    found, strength = [], []
    while len(found) < count and left.any():
        best = int(left.argmax())
        found.append(best)
        strength.append(left[best])
        away = ((points - points[best]) ** 2).sum(axis=1) / radius**2
        left *= np.where(away <= 1, 0.0, 1 - np.exp(-away / (2 * FADING**2)))
    order, ids = tied(np.array(strength)), np.array(found, dtype=np.int64)
    return ids[by_place(order, points[ids])]


def tied(values: np.ndarray) -> np.ndarray:
    """(k,) i8: for values (k,), largest first, the number of those that are larger by more than TIE, as far as known.

    The first value, and all that are equal to it within TIE, get 0; the next one starts another group, and so on.
    """
    groups = np.zeros(len(values), dtype=np.int64)
    for k in range(1, len(values)):
        head = values[groups[k - 1]]
        groups[k] = groups[k - 1] if values[k] >= (1 - TIE) * head else k
    return groups


def by_place(groups: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(k,) the order of points (k, 3) by group, then by height, distance from the z axis, x and y."""
    x, y, z = points.round(DIGITS).T
    return np.lexsort((-y, -x, -np.hypot(x, y).round(DIGITS), -z, groups))
