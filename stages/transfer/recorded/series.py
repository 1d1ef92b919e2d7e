"""From a series of readings of a finger's cells to one picture: all of it, or one instant (T5.1.4)."""

import math

import numpy as np

SPREAD = 0.99  # share of the readings within the range of grey values; the others are clipped


def as_grey(changes: np.ndarray) -> np.ndarray:
    """Changes of readings, of any shape, as u1: grey 128 is no change, and one factor scales the whole set."""
    span = np.quantile(np.abs(changes), SPREAD) or 1
    return np.round(128 + 127 * np.clip(changes / span, -1, 1)).astype(np.uint8)


def colour_image(series: np.ndarray) -> np.ndarray:
    """(side, side, 3): a tactile series (rows, columns, samples) as one colour image, by Matlab's reshape (T5.1.4).

    In Matlab the first axis varies fastest. Of BiGS's 7 x 3 x 700 values, that of row r, column c, sample t has index
    n = r + 7 c + 21 t, and pixel (i, j) of channel k has index n = i + 70 j + 4900 k. So the colours are the three
    thirds of the seven seconds, 233 1/3 samples each. The 21 cells of a sample are below one another, and a column of
    pixels has 3 1/3 samples. Raises ValueError for a number of values that is not three times a square.
    """
    series = np.asarray(series)
    side = math.isqrt(series.size // 3)
    return series.reshape(side, side, 3, order="F")


def strongest_instant(series: np.ndarray) -> np.ndarray:
    """(rows, columns): the instant of a series (rows, columns, samples) u1 whose grey differs most from 128.

    The thesis takes readings "acquired while grasping" and does not say which (T5.1.4); this one has the most to tell.
    """
    change = np.abs(series.astype(np.int64) - 128).sum(axis=(0, 1))
    return series[..., change.argmax()]
