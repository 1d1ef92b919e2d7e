"""Where recognition breaks: the severity at which it has lost half of its lead over guessing."""

import numpy as np

BROKEN = 0.5  # of the lead over chance that is left


def lead_left(accuracy, clean, chance):
    """What is left of the lead over guessing: 1 as good as undisturbed, 0 no better than guessing.

    NaN where clean touches are recognised no better than by guessing: there is no lead to lose.
    """
    ahead = np.asarray(accuracy, dtype=np.float64) - chance
    return ahead / (clean - chance) if clean > chance else np.full_like(ahead, np.nan)


def breaking_point(severities, left, unharmed):
    """The mildest severity at which less than half of the lead is left, interpolated; NaN if there is none.

    severities (s,) from mild to harsh, in either direction; left (s,) as `lead_left` gives it; 1 at `unharmed`.
    """
    severities, left = [unharmed, *severities], [1.0, *left]
    for k in range(1, len(left)):
        if left[k] < BROKEN:
            share = (left[k - 1] - BROKEN) / (left[k - 1] - left[k])
            return float(severities[k - 1] + share * (severities[k] - severities[k - 1]))
    return float("nan")
