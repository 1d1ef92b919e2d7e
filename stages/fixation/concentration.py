"""How concentrated a saliency is: the thesis's deep maps are one or two regions, its classical ones broad (T3.4)."""

import numpy as np


def half_share(values: np.ndarray, areas: np.ndarray) -> float:
    """The least share of a surface that holds half of a saliency: 0.5 where it is even, near 0 for one small place.

    values (n,) at the vertices, which weigh by their areas (n,) and count from the least on, since a saliency has no
    zero of its own. NaN where the values are constant.
    """
    values, areas = np.asarray(values, dtype=np.float64), np.asarray(areas, dtype=np.float64)
    above = values - values.min(initial=np.inf)
    if not (above * areas).any():
        return np.nan
    order = np.argsort(-above, kind="stable")
    held, covered = np.cumsum((above * areas)[order]), np.cumsum(areas[order])
    return float(np.interp(0.5, held / held[-1], covered / covered[-1]))
