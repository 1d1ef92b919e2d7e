"""How deep a bed of springs is pressed by a load, compiled by numba."""

import numpy as np

from .jit import kernel


@kernel
def depths_of_loads(gaps: np.ndarray, weights: np.ndarray, loads: np.ndarray, limit: float) -> np.ndarray:
    """(k,) depths d, from each row's least gap, at which sum(weights * max(d - gap, 0)) is the load; inf without a gap.

    gaps (k, n), inf where there is nothing; weights (n,), 0 or more; loads (k,), above 0. Springs farther than `limit`
    are left out: a depth above it is too deep, whatever its value. The sum is convex and piecewise linear in d, so that
    Newton's method from above ends at the exact root: springs that are out of contact stay out (Michelot 1986).
    """
    depths, near, weight = np.empty(len(gaps)), np.empty(gaps.shape[1]), np.empty(gaps.shape[1])
    for k in range(len(gaps)):
        first = np.inf
        for gap in gaps[k]:
            first = min(first, gap)
        size, depth = 0, limit
        for j in range(gaps.shape[1]):
            if gaps[k, j] - first <= limit and weights[j] > 0:
                near[size], weight[size] = gaps[k, j] - first, weights[j]
                size += 1
        kept = -1
        while kept != size:
            size = size if kept < 0 else kept
            total, moment, kept = 0.0, 0.0, 0
            for j in range(size):
                total += weight[j]
                moment += weight[j] * near[j]
            depth = (loads[k] + moment) / total
            for j in range(size):
                if near[j] <= depth:
                    near[kept], weight[kept] = near[j], weight[j]
                    kept += 1
        depths[k] = depth
    return depths
