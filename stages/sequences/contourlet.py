"""Sixteen directions of an imprint, after the contourlet transform (Do and Vetterli 2005, T [261]; T4.4.9)."""

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike

DIRECTIONS = 16  # T4.4.9
EDGE = 0.5  # of a wedge's width: the width of the smooth transition between two neighbours
SMALLEST = 4  # rows and columns, below which a wedge contains no frequency
BATCH = 4096  # images transformed at once, which bounds the memory


def directional_std(images: ArrayLike, count: int = DIRECTIONS) -> np.ndarray:
    """(k, count) f8: standard deviation of each directional sub-band of images (k, rows, cols), u1 or floats.

    Integers up to 16 bits are scaled from 0..255 to 0..1 and transformed in single precision. The frequency plane is
    divided into `count` wedges like the directional filter bank of Do and Vetterli (their figure 2): half of them
    mostly horizontal, half mostly vertical, equally wide along the border of the square, with axes and diagonals on the
    boundaries between wedges. A wedge with the frequencies of direction (x, y) responds to stripes perpendicular to it.
    Sub-band 0 begins at the x axis and has y from 0 to x * 4 / count.

    The wedges are real, smooth masks on the Fourier transform whose squares add up to one: a tight frame as in Lu and
    Do (2006). By Parseval's theorem the standard deviation of a sub-band is the root of its energy, and the squares of
    all sub-bands add up to the variance of the image. There are three differences from the sampled filter bank. No
    sub-band is decimated, so that a shift of one cell changes nothing. The wedges are sharper. All scales but the mean
    are pooled, since the thesis has one number per direction and names no level of the pyramid. The image is continued
    periodically, as in the authors' program, so that the discontinuity at its border counts as a stripe.
    Raises ValueError for another shape, fewer than 4 x 4 cells, an odd number of directions, or NaN.
    """
    images = np.asarray(images)
    if images.ndim != 3 or min(images.shape[1:]) < SMALLEST:
        raise ValueError(f"images must have shape (k, rows, cols), at least {SMALLEST} x {SMALLEST}: {images.shape}")
    if count < 2 or count % 2:
        raise ValueError(f"directions must be an even number from 2, got {count}")
    if images.dtype.kind == "f" and not np.isfinite(images).all():
        raise ValueError("images hold NaN or infinite values")
    rows, columns = images.shape[1:]
    weights = wedges(rows, columns, count).reshape(count, -1).T
    scale = (255.0 if images.dtype.kind in "iu" else 1.0) * images[0].size if len(images) else 1.0
    found = np.empty((len(images), count))
    for start in range(0, len(images), BATCH):
        part = images[start : start + BATCH].astype(np.result_type(images, np.float32))
        spectrum = np.asarray(scipy.fft.rfft2(part - part.mean(axis=(1, 2), keepdims=True)))
        power = (np.real(spectrum) ** 2 + np.imag(spectrum) ** 2).reshape(len(part), len(weights))
        found[start : start + BATCH] = np.sqrt(power @ weights.astype(power.dtype)) / scale
    return found


def wedges(rows: int, columns: int, count: int = DIRECTIONS) -> np.ndarray:
    """(count, rows, columns // 2 + 1): the share of each frequency of an rfft2 that belongs to each direction.

    A column that also represents its mirror image counts twice. Over the directions the shares add up to 1 or 2. The
    mean (0, 0) belongs to none.
    """
    down, along = np.meshgrid(np.fft.fftfreq(rows), np.fft.rfftfreq(columns), indexing="ij")
    found = np.zeros((count, *down.shape))
    # The highest frequency of an even length is its own mirror image: it represents both signs.
    signs = [(row, column) for row in (1, -1) for column in (1, -1)]
    for row, column in signs:
        y = np.where(down == -0.5, row * down, down)
        x = np.where(along == 0.5, column * along, along)
        found += _wedge_shares(border_position(x, y), count) / len(signs)
    found[:, 0, 0] = 0
    mirrored = (along > 0) & (along < 0.5)
    return found * np.where(mirrored, 2, 1)


def border_position(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The position of the direction (x, y) on half of the border of the square: 0 to 4, periodic.

    0 is horizontal, 1 the diagonal x = y, 2 vertical, 3 the other diagonal.
    """
    level = np.abs(y) <= np.abs(x)
    slope = np.divide(y, x, out=np.zeros_like(x), where=level & (x != 0))
    steep = np.divide(x, y, out=np.zeros_like(x), where=~level)
    return np.where(level, slope, 2 - steep) % 4


def _wedge_shares(positions, count):
    """(count, ...): the share of the energy that belongs to each wedge at these positions; the shares add up to 1."""
    width = 4 / count
    offsets = np.arange(count).reshape(-1, *[1] * positions.ndim) * width
    inside = (positions - offsets + 2) % 4 - 2  # -2..2, 0 at the first border of the wedge
    return _smooth_step(inside / (EDGE * width)) - _smooth_step((inside - width) / (EDGE * width))


def _smooth_step(t):
    """Rises from 0 to 1 between -1/2 and 1/2 as a squared sine."""
    return np.sin(np.pi / 2 * np.clip(t + 0.5, 0, 1)) ** 2
