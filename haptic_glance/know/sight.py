"""Features of a small picture: gradients and grey values, compared where nothing hides them.

A picture is compared with rendered views of each known mesh in each pose. Only cells of the picture that nothing hides
count.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

SIDE = 96  # pixels of a picture, from which the features are computed
CELLS, DIRECTIONS, GREYS = 8, 8, 24  # cells a side, directions of gradients in each, and grey values a side
CONTRAST = 0.5  # of a cell's gradients, below which they count less
SPREAD = 1e-3  # of the grey values, a picture with less shows nothing

Features = Callable[[np.ndarray], np.ndarray]  # (n, 96, 96) in 0..1 to (n, d)


@dataclass(frozen=True)
class Sketch:
    """The features of pictures: gradients (n, 64, 8) of unit length a cell, greys (n, 576)."""

    gradients: np.ndarray
    greys: np.ndarray


def sketch(pictures: np.ndarray) -> Sketch:
    """The Sketch of pictures (n, 96, 96) in 0..1."""
    pictures = np.asarray(pictures, dtype=np.float32)
    down, right = np.gradient(pictures, axis=(1, 2))
    strength = np.hypot(down, right)
    direction = ((np.arctan2(down, right) + np.pi) * (DIRECTIONS / (2 * np.pi))).astype(np.int8) % DIRECTIONS
    count, step = len(pictures), SIDE // CELLS
    gradients = np.empty((count, CELLS * CELLS, DIRECTIONS), dtype=np.float32)
    for one in range(DIRECTIONS):
        of_one = np.where(direction == one, strength, 0).reshape(count, CELLS, step, CELLS, step)
        gradients[:, :, one] = of_one.sum(axis=(2, 4)).reshape(count, -1)
    gradients = np.sqrt(gradients / (gradients.sum(axis=2, keepdims=True) + CONTRAST))
    return Sketch(gradients, blocks(pictures, GREYS))


def blocks(pictures: np.ndarray, side: int) -> np.ndarray:
    """(n, side * side): means of pictures (n, 96, 96) over side x side blocks."""
    step = SIDE // side
    return pictures.reshape(len(pictures), side, step, side, step).mean(axis=(2, 4)).reshape(len(pictures), -1)


def similarity(picture: Sketch, views: Sketch, seen: np.ndarray) -> np.ndarray:
    """(2, v): cosines of the gradients and of the grey values of one picture with those of views, where it is seen.

    seen (96, 96): 1 where nothing hides the object.
    """
    cells, greys = blocks(seen[None].astype(np.float32), CELLS)[0], blocks(seen[None].astype(np.float32), GREYS)[0]
    mine = (picture.gradients[0] * cells[:, None]).ravel()
    flat = views.gradients.reshape(len(views.gradients), -1)
    lengths = np.sqrt((views.gradients**2).sum(axis=2) @ cells)
    own = np.sqrt((picture.gradients[0] ** 2).sum(axis=1) @ cells)
    first = flat @ mine / np.maximum(lengths * own, 1e-6)
    share = max(float(greys.sum()), 1e-6)
    target = picture.greys[0] - picture.greys[0] @ greys / share
    means = views.greys @ greys / share
    products = views.greys @ (target * greys)
    spreads = (views.greys**2) @ greys - share * means**2
    second = products / np.sqrt(np.maximum(spreads * ((target**2) @ greys), 1e-6))
    return np.stack([first, second])


def board(is_object: np.ndarray, share: float, random: np.random.Generator) -> np.ndarray:
    """A board with a straight edge at a random angle, which hides a share of an object from the camera.

    Parameters
    ----------
    is_object : (h, w) array of bool
        True at the pixels of the picture that show the object.
    share : float
        Share of these pixels that the board hides, from 0 to 1.
    random : numpy.random.Generator
        Draws the angle of the edge.

    Returns
    -------
    (h, w) array of bool
        True where the board is. All False where no object is seen.
    """
    rows, columns = np.nonzero(is_object)
    angle = 2 * np.pi * random.random()
    if share <= 0 or not len(rows):
        return np.zeros(is_object.shape, dtype=bool)
    along = np.cos(angle) * np.arange(is_object.shape[1])[None] + np.sin(angle) * np.arange(is_object.shape[0])[:, None]
    return along > np.quantile(along[rows, columns], 1 - share)


def prepared(picture: ArrayLike, hidden: ArrayLike | None) -> tuple[np.ndarray, np.ndarray]:
    """(picture (96, 96) in 0..1, seen (96, 96)) of a picture in bytes, whose middle square is taken.

    hidden: True where something else is seen than the object and its background. Raises ValueError for pictures and
    masks of other kinds, and for a picture that shows nothing.
    """
    picture = np.asarray(picture)
    if picture.ndim not in (2, 3) or (picture.ndim == 3 and picture.shape[2] not in (3, 4)) or 0 in picture.shape:
        raise ValueError(f"a picture must have shape (h, w) or (h, w, 3), got {picture.shape}")
    if not np.isfinite(picture).all():
        raise ValueError("the picture holds NaN or infinite values")
    if picture.dtype != np.uint8:
        raise ValueError(f"a picture must hold bytes (uint8), got {picture.dtype}: multiply shares by 255 and convert")
    grey = (picture if picture.ndim == 2 else picture[..., :3].mean(axis=2)).astype(np.float32) / 255
    covered = np.zeros(grey.shape, dtype=bool) if hidden is None else np.asarray(hidden)
    if covered.shape != grey.shape:
        raise ValueError(f"the mask of what is hidden has shape {covered.shape}, the picture {grey.shape}")
    if not np.isin(covered, (0, 1)).all():
        raise ValueError("the mask of what is hidden must hold True and False")
    seen = 1 - _middle_square(covered.astype(np.float32), 1.0)
    grey = _middle_square(grey, 0.0)
    if seen.max() < 0.5:
        raise ValueError("all of the picture is hidden: touch without a look, from library.belief()")
    if np.ptp(grey[seen >= 0.5]) < SPREAD:
        raise ValueError("the picture shows nothing: all of its visible pixels have one grey value")
    return grey, seen


def _middle_square(values, border):
    """The middle square of values (h, w), as high as these, at SIDE x SIDE; what lies beyond the sides is `border`."""
    height, width = values.shape
    first, last = (width - height) // 2, (width - height) // 2 + height
    square = np.pad(values, ((0, 0), (max(-first, 0), max(last - width, 0))), constant_values=border)
    square = square[:, max(first, 0) : max(first, 0) + height]
    return _resized(_resized(square, SIDE).T, SIDE).T


def _resized(values, count):
    """(count, n) means of values (m, n) over equal parts of the first axis, or interpolated where there are fewer."""
    size = len(values)
    if size == count:
        return values
    if size < count:
        places = (np.arange(count) + 0.5) * size / count - 0.5
        low = np.clip(np.floor(places).astype(int), 0, size - 1)
        share = np.clip(places - low, 0, 1).astype(np.float32)[:, None]
        return values[low] * (1 - share) + values[np.minimum(low + 1, size - 1)] * share
    sums = np.concatenate([np.zeros((1, values.shape[1]), np.float32), np.cumsum(values, axis=0, dtype=np.float64)])
    edges = np.arange(count + 1) * size / count
    low = np.minimum(edges.astype(int), size - 1)
    at = sums[low] + (edges - low)[:, None] * values[low]
    return (np.diff(at, axis=0) * (count / size)).astype(np.float32)
