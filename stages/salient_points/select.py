"""Salient pixels of one saliency map: by threshold and centroid (T3.1.2), or by suppression (T3.2.5)."""

from dataclasses import dataclass

import cv2
import numpy as np

from .kernels import suppress

SUPPRESSION_THRESHOLD = 0.9  # of the map's maximum; T3.2.5
REGION_SHARE = 0.3  # of the object's pixels, the most salient ones; T3.1.1


@dataclass(frozen=True)
class SelectedPixels:
    """Pixels of one map, most salient first: rows, columns (k,) i8, values (k,) f8.

    strong: how many leading ones pass the thesis's threshold; the others only fill up the count.
    """

    rows: np.ndarray
    columns: np.ndarray
    values: np.ndarray
    strong: int


def select_by_suppression(
    image: np.ndarray, radius: float, count: int | None = None, threshold: float = SUPPRESSION_THRESHOLD
) -> SelectedPixels:
    """Takes the largest value, sets its neighbourhood to zero, and repeats down to `threshold` of the maximum (T3.2.5).

    image (h, w), zero off the object; radius in pixels: all points are farther apart. count: how many, going on below
    the threshold where needed, as long as there are pixels above zero; None stops at the threshold. A map of zeros
    gives no points. Raises ValueError for a map that is empty, not 2D, negative or NaN, and for a negative radius or
    count.
    """
    image = check_map(image)
    left = image.copy()
    if radius < 0 or (count is not None and count < 0):
        raise ValueError(f"radius and count must not be negative, got {radius} and {count}")
    floor = threshold * left.max()
    taken = suppress(left, radius, left.size if count is None else count, floor if count is None else 0.0)
    rows, columns = np.unravel_index(taken, left.shape)
    values = image[rows, columns]
    return SelectedPixels(rows, columns, values, int((values > floor).sum()))


def select_by_centroid(image: np.ndarray, count: int | None = None, share: float = REGION_SHARE) -> SelectedPixels:
    """Centroids of the connected regions among the `share` of highest saliency values (T3.1.1, T3.1.2).

    image (h, w), zero off the object: the share is of the pixels above zero. Pixels that touch at a corner are
    connected. The centroid of a concave region may lie outside it, so the region's pixel nearest to it is taken.
    Ordered by the region's highest value. Every centroid is strong; count keeps the first ones. Raises ValueError as
    select_by_suppression does, and for a share outside 0..1.
    """
    image = check_map(image)
    if not 0 < share <= 1:
        raise ValueError(f"share must be above 0 and at most 1, got {share}")
    if not image.any():
        none = np.zeros(0, dtype=np.int64)
        return SelectedPixels(none, none, np.zeros(0), 0)
    region = (image > 0) & (image >= np.quantile(image[image > 0], 1 - share))
    labels = cv2.connectedComponents(region.astype(np.uint8), connectivity=8)[1]
    rows, columns = np.nonzero(region)
    label = labels[rows, columns]
    order = np.argsort(label, kind="stable")
    members = np.split(order, np.flatnonzero(np.diff(label[order])) + 1)
    centres = np.array([_central_member(rows[ids], columns[ids]) for ids in members])
    peaks = np.array([image[rows[ids], columns[ids]].max() for ids in members])
    first = np.argsort(-peaks, kind="stable")[:count]
    return SelectedPixels(centres[first, 0], centres[first, 1], peaks[first], len(first))


def _central_member(rows, columns):
    distance = (rows - rows.mean()) ** 2 + (columns - columns.mean()) ** 2
    nearest = distance.argmin()
    return rows[nearest], columns[nearest]


def check_map(image: np.ndarray) -> np.ndarray:
    """The map as (h, w) f8; raises ValueError when it is empty, not 2D, negative or not finite."""
    image = np.asarray(image, dtype=np.float64)
    if image.ndim != 2 or image.size == 0:
        raise ValueError(f"a saliency map must have shape (h, w) and at least one pixel, got {image.shape}")
    if not np.isfinite(image).all() or image.min() < 0:
        raise ValueError("a saliency map must be finite and not negative")
    return image
