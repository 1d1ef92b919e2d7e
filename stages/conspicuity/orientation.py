"""Orientation: bars and edges that lie otherwise than their surround."""

import cv2
import numpy as np

from .operators import CENTRES, COMMON, DELTAS, centre_surround, normalise
from .picture import picture

ANGLES = (0, 45, 90, 135)  # degrees, counter-clockwise from the horizontal: the way the preferred bar lies
WAVELENGTH = 4.0  # pixels of the scale: Greenspan et al., Overcomplete steerable pyramid filters, CVPR 1994 (Itti's)
SIGMA = 1.5  # pixels: short enough that the coarse scales still tell one part of the object from another
RADIUS = 4  # 9 x 9 pixels
FALL = 0.5  # of the gain from scale to scale: answers are per pixel of the view, see `orientation`


def orientation(mesh, view, filled=True):
    """The orientation conspicuity map (h / 16, w / 16) f4 in 0..1, T eq. 3.2, of a stages.views.View.

    T and its sources leave the gain between scales open. With equal gain a plain edge answers alike at all scales, so
    that |O(c) - O(s)| is zero on the edge and high on the empty surface beside it; with a gain per pixel of the view,
    half at each coarser scale, the edge itself stands out.
    """
    image = picture(view, filled)
    if image.empty:
        return image.nothing()
    levels = {s: image.intensity_pyramid[s] for s in range(CENTRES[0], CENTRES[-1] + DELTAS[-1] + 1)}
    total = 0
    for angle in ANGLES:
        energies = {scale: energy(level, angle) * FALL ** (scale - CENTRES[0]) for scale, level in levels.items()}
        total = total + normalise(centre_surround(energies, image.cover), image.cover[COMMON])
    return image.whole(normalise(total, image.cover[COMMON]), COMMON)


def energy(image, angle):
    """(h, w) f4: length of the even and odd Gabor responses of an image (h, w) f4, at an angle in degrees."""
    even, odd = (cv2.filter2D(image, cv2.CV_32F, k, borderType=cv2.BORDER_REPLICATE) for k in gabor(angle))
    # cv2.magnitude's last bit depends on where the arrays lie in memory; each of these steps is rounded exactly.
    return np.sqrt(even * even + odd * odd)


def gabor(angle):
    """The even and odd Gabor kernels of an angle, of unit gain, blind to plain grey and to an even slope.

    What is left of a Gabor's answer to either would, at the coarse scales, drown every bar in smooth shading.
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
