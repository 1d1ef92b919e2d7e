"""The structural dissimilarity of two pictures (T3.1.4, T3.2.9.2)."""

import cv2
import numpy as np

from stages.kit.similarity import WINDOW, ssim_map


def ssim_error(
    reference: np.ndarray, picture: np.ndarray, moments: tuple[np.ndarray, np.ndarray] | None = None
) -> float:
    """1 - SSIM of two pictures (rows, columns), 0 to 255, averaged over every pixel of the picture.

    moments: stages.kit.similarity.local_moments(reference), where the reference serves many comparisons.
    """
    top, bottom, left, right = _content_box(reference, picture)
    inside = slice(top, bottom), slice(left, right)
    known = None if moments is None else (moments[0][inside].copy(), moments[1][inside].copy())  # compiled for rows
    return float((1 - ssim_map(reference[inside], picture[inside], known)).sum() / reference.size)


def _content_box(reference, picture):
    """(top, bottom, left, right) of the content of both pictures, outside of which they are equal: the same sum."""
    content = np.maximum(reference, picture) > 0
    left, top, width, height = cv2.boundingRect(content.view(np.uint8))
    return max(top - WINDOW, 0), top + height + WINDOW, max(left - WINDOW, 0), left + width + WINDOW
