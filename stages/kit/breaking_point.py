"""Breaking point: the severity of a perturbation at which half of a score's lead is lost."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

BROKEN = 0.5  # share of the lead that is left at the breaking point


def lead_left(accuracy: ArrayLike, clean: float, chance: float) -> np.ndarray:
    """The share of the lead over chance that is left: 1 for the undisturbed accuracy `clean`, 0 at chance.

    accuracy: any shape. NaN if `clean` is at chance or below, since there is no lead to lose.
    """
    lead = np.asarray(accuracy, dtype=np.float64) - chance
    return lead / (clean - chance) if clean > chance else np.full_like(lead, np.nan)


def breaking_point(severities: Sequence[float], left: Sequence[float], unharmed: float) -> float:
    """The mildest severity at which less than half is left, linearly interpolated; NaN if there is none.

    severities (s,): from mild to harsh, rising or falling; left (s,): a share such as that of `lead_left` or the
    repeatability; unharmed: the severity that changes nothing, where the share is 1.
    """
    severities, left = [unharmed, *severities], [1.0, *left]
    for k in range(1, len(left)):
        if left[k] < BROKEN:
            share = (left[k - 1] - BROKEN) / (left[k - 1] - left[k])
            return float(severities[k - 1] + share * (severities[k] - severities[k - 1]))
    return float("nan")
