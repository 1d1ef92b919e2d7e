"""The difference of two pictures without their local means, at six scales (T3.1.4, T [225]).

The root of the mean squared difference of each of six bands, averaged over the bands, on a scale where white is 1:
coarse bands have the same weight as fine ones, which have more pixels. The thesis's "predicted distance in Laplacian
domain" is the second number that the authors' own program gives, beside the normalised one.

Source: Laparra, Balle, Berardino and Simoncelli, Perceptual image quality assessment using a normalized Laplacian
pyramid, Electronic Imaging 2016 (T [225]). The filter is the binomial of Burt and Adelson 1983, as in plenoptic (Duong
et al. 2023); the authors' program takes 0.05, 0.25, 0.4, 0.25, 0.05, within 0.025 of it per tap.
"""

from collections.abc import Sequence

import cv2
import numpy as np

SCALES = 6  # Laparra et al. 2016: five bands and the remaining small picture
WHITE = 255.0  # the measure is defined on 0 to 1


def laplacian_pyramid(picture: np.ndarray) -> list[np.ndarray]:
    """Six bands, fine to coarse, of a picture (rows, columns), 0 to 255; the last is a small picture."""
    bands, rest = [], np.asarray(picture, dtype=np.float32) / np.float32(WHITE)
    for _ in range(SCALES - 1):
        small = cv2.pyrDown(rest)
        bands.append(rest - _enlarge(small, rest.shape))
        rest = small
    return [*bands, rest]


def _enlarge(small, shape):
    """A picture twice as large, of `shape`; mirrored at the border, where OpenCV by itself repeats the last row."""
    padded = cv2.copyMakeBorder(small, 1, 1, 1, 1, cv2.BORDER_REFLECT_101)
    return cv2.pyrUp(padded)[2 : 2 + shape[0], 2 : 2 + shape[1]]


def band_distance(reference: Sequence[np.ndarray], bands: Sequence[np.ndarray]) -> float:
    """Root mean square over the pixels of a band, mean over the bands (Laparra et al. 2016)."""
    roots = [cv2.norm(a, b) / np.sqrt(a.size) for a, b in zip(reference, bands, strict=True)]
    return float(np.mean(roots))
