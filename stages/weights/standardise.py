"""Standardises a value per vertex by area."""

import numpy as np


def standardise(values: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """values (n,) minus their area-weighted mean, over their deviation.

    Zeros if the values are constant, and at vertices without area.
    """
    total = areas.sum()
    if not total > 0:
        return np.zeros(len(values))
    centred = np.where(areas > 0, values - (values * areas).sum() / total, 0)
    deviation = np.sqrt((centred**2 * areas).sum() / total)
    level = np.abs(values[areas > 0]).max()
    return centred / deviation if deviation > 1e-9 * max(level, 1e-30) else np.zeros(len(values))
