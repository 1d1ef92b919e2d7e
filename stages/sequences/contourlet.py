"""Sixteen directions of an imprint, after the contourlet transform (Do and Vetterli 2005, T [261]; T4.4.9)."""

import numpy as np
import scipy.fft

DIRECTIONS = 16  # T4.4.9
EDGE = 0.5  # of a wedge's width: how wide the smooth passage between two neighbours is
SMALLEST = 4  # rows and columns below which wedges hold no frequency at all
BATCH = 4096  # images transformed at once: a bounded piece of memory, whatever the number of imprints


def directions(images, count=DIRECTIONS):
    """(k, count) f8: standard deviation of each directional sub-band of images (k, rows, cols), u1 or floats.

    Whole numbers count as 0..255 of a full scale of 1. The plane of frequencies is cut into `count` wedges as the
    directional filter bank of Do and Vetterli cuts it (their figure 2): half of them mostly level, half mostly upright,
    equally wide along the border of the square, axes and diagonals on seams. A wedge that holds the frequencies of
    direction (x, y) answers to stripes across it: sub-band 0 is that of x alone, with y from 0 to x * 4 / count.

    Here the wedges are real, smooth masks on the Fourier transform whose squares add up to one, a tight frame as in Lu
    and Do (2006): by Parseval the standard deviation of a sub-band is the root of its energy, and the squares of all
    sub-bands add up to the variance of the image. It differs from the sampled filter bank thrice: nothing is thrown
    away (no sub-band is decimated, so a shift of one cell changes nothing), the wedges are sharper, and all scales but
    the mean count together, since the thesis has one number a direction and names no level of the pyramid. The image is
    continued periodically, as in the authors' own programme; the seam counts as a stripe along its axis.
    Raises ValueError for another shape, fewer than 4 x 4 cells, an odd number of directions, or NaN.
    """
    images = np.asarray(images)
    if images.ndim != 3 or min(images.shape[1:]) < SMALLEST:
        raise ValueError(f"images must have shape (k, rows, cols), at least {SMALLEST} x {SMALLEST}: {images.shape}")
    if count < 2 or count % 2:
        raise ValueError(f"directions must be an even number from 2, got {count}")
    if images.dtype.kind == "f" and not np.isfinite(images).all():
        raise ValueError("images hold NaN or infinite values")
    weights = wedges(*images.shape[1:], count).reshape(count, -1).T
    scale = (255.0 if images.dtype.kind in "iu" else 1.0) * images[0].size if len(images) else 1.0
    found = np.empty((len(images), count))
    for start in range(0, len(images), BATCH):
        part = images[start : start + BATCH].astype(np.float64)
        spectrum = scipy.fft.rfft2(part - part.mean(axis=(1, 2), keepdims=True))
        power = (spectrum.real**2 + spectrum.imag**2).reshape(len(part), len(weights))
        found[start : start + BATCH] = np.sqrt(power @ weights) / scale
    return found


def wedges(rows, columns, count=DIRECTIONS):
    """(count, rows, columns // 2 + 1): the share of each frequency of an rfft2 that each direction takes.

    A column that stands for its mirror image too counts twice. Over the directions the shares add up to 1 or 2; the
    mean (0, 0) is in none.
    """
    down, along = np.meshgrid(np.fft.fftfreq(rows), np.fft.rfftfreq(columns), indexing="ij")
    found = np.zeros((count, *down.shape))
    # The highest frequency of an even length is its own mirror image: it stands for both signs alike.
    signs = [(row, column) for row in (1, -1) for column in (1, -1)]
    for row, column in signs:
        y = np.where(down == -0.5, row * down, down)
        x = np.where(along == 0.5, column * along, along)
        found += _shares(place(x, y), count) / len(signs)
    found[:, 0, 0] = 0
    mirrored = (along > 0) & (along < 0.5)
    return found * np.where(mirrored, 2, 1)


def place(x, y):
    """Where a frequency's direction lies along the border of the square: 0 to 4 once round half of it, periodic.

    0 is level (x alone), 1 the diagonal x = y, 2 upright, 3 the other diagonal.
    """
    level = np.abs(y) <= np.abs(x)
    slope = np.divide(y, x, out=np.zeros_like(x), where=level & (x != 0))
    steep = np.divide(x, y, out=np.zeros_like(x), where=~level)
    return np.where(level, slope, 2 - steep) % 4


def _shares(places, count):
    """(count, ...): how much of its energy each wedge takes at these places; over the wedges they add up to 1."""
    width = 4 / count
    offsets = np.arange(count).reshape(-1, *[1] * places.ndim) * width
    inside = (places - offsets + 2) % 4 - 2  # -2..2, 0 at the wedge's first seam
    return _rise(inside / (EDGE * width)) - _rise((inside - width) / (EDGE * width))


def _rise(t):
    """From 0 to 1 between -1/2 and 1/2, smooth: sine squared."""
    return np.sin(np.pi / 2 * np.clip(t + 0.5, 0, 1)) ** 2
