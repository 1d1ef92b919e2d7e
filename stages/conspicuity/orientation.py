"""Orientation: bars and edges whose direction differs from that of their surround."""

from functools import cache

import cv2
import numpy as np

from stages.kit import Mesh
from stages.views import View

from .cropped_view import cropped_view
from .operators import CENTRES, DELTAS, OUTPUT_SCALE, centre_surround, normalise

ANGLES = (0, 45, 90, 135)  # degrees, counter-clockwise from the horizontal, the direction of the preferred bar
WAVELENGTH = 4.0  # pixels of the scale: Greenspan et al., Overcomplete steerable pyramid filters, CVPR 1994 (Itti's)
SIGMA = 1.5  # pixels; small enough that the coarse scales still resolve the parts of the object
RADIUS = 4  # 9 x 9 pixels
GAIN = 0.5  # from each scale to the next coarser one: responses are per pixel of the view, see `orientation`


def orientation(mesh: Mesh, view: View, filled: bool = True) -> np.ndarray:
    """The orientation conspicuity map (h / 16, w / 16) f4 in 0..1, T eq. 3.2, of a stages.views.View.

    T and its sources do not state the gain between scales. With equal gain a plain edge has the same response at all
    scales, so that |O(c) - O(s)| is zero on the edge and high on the empty surface next to it. With a gain per pixel
    of the view, half at each coarser scale, the edge itself stands out.
    """
    image = cropped_view(view, filled)
    if image.empty:
        return image.zero_map()
    levels = {s: image.intensity_pyramid[s] for s in range(CENTRES[0], CENTRES[-1] + DELTAS[-1] + 1)}
    total = np.zeros(image.cover[OUTPUT_SCALE].shape, dtype=np.float32)
    for angle in ANGLES:
        energies = {scale: energy(level, angle) * GAIN ** (scale - CENTRES[0]) for scale, level in levels.items()}
        total = total + normalise(centre_surround(energies, image.cover), image.cover[OUTPUT_SCALE])
    return image.place_in_view(normalise(total, image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)


def energy(image: np.ndarray, angle: float) -> np.ndarray:
    """(h, w) f4: magnitude of the even and odd Gabor responses of an image (h, w) f4, at an angle in degrees."""
    even, odd = (cv2.filter2D(image, cv2.CV_32F, k, borderType=cv2.BORDER_REPLICATE) for k in gabor(angle))
    # Not cv2.magnitude, whose last bit depends on memory alignment.
    return np.sqrt(even * even + odd * odd)


@cache
def gabor(angle: float) -> tuple[np.ndarray, np.ndarray]:
    """The even and odd Gabor kernels of an angle, of unit gain, without response to a constant or a linear slope.

    A plain Gabor kernel responds slightly to both, and at coarse scales smooth shading would mask every bar.
    """
    x, y = np.meshgrid(np.arange(-RADIUS, RADIUS + 1), np.arange(RADIUS, -RADIUS - 1, -1))
    across = y * np.cos(np.radians(angle)) - x * np.sin(np.radians(angle))
    envelope = np.exp(-(x**2 + y**2) / (2 * SIGMA**2))
    wave = np.exp(2j * np.pi * across / WAVELENGTH) * envelope
    wave -= envelope * (wave.sum() / envelope.sum())
    slope = envelope * across
    wave -= slope * ((wave * across).sum() / (slope * across).sum())
    wave /= np.abs(wave).sum() / 2
    return wave.real.astype(np.float32), wave.imag.astype(np.float32)
