"""The fewest faces that are enough."""

import numpy as np


def coarsest(passes: np.ndarray) -> int:
    """The last level of those passes (levels,), finest first, that pass with all finer ones; 0 where the first fails.

    A coarse level that passes by luck, after a finer one that fails, is not enough.
    """
    failing = np.flatnonzero(~np.asarray(passes, dtype=bool))
    return max(int(failing[0]) - 1, 0) if len(failing) else len(passes) - 1
