"""sRGB, the encoding of colours (IEC 61966-2-1). Pictures and meshes hold it; factors of glTF are linear."""

import numpy as np


def encoded(linear: np.ndarray) -> np.ndarray:
    """Colours of 0..1 as sRGB, of linear ones; values outside are clipped."""
    linear = np.clip(linear, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def decoded(srgb: np.ndarray) -> np.ndarray:
    """Linear colours of 0..1, of those as sRGB."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def multiplied(colors: np.ndarray, factor: np.ndarray) -> np.ndarray:
    """Colours (..., 3) u1 as sRGB, times a linear factor (3,); a factor of one leaves the bytes alone."""
    if (factor == 1).all():
        return colors
    levels = decoded(np.arange(256) / 255)[:, None] * factor
    return np.rint(255 * encoded(levels)).astype(np.uint8)[colors, np.arange(3)]
