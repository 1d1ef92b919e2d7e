"""The formulas of T3.1.1 and T3.2 to the letter: the whole picture on its background, and N with all local maxima.

The other modules of this package hold our own formulas. Three readings of the letter are here:

- `printed`: N multiplies by (M - m)^2, where m is the mean of all local maxima, the highest included. T eq. 3.3 and 3.4
  subtract the surround's G - R from the centre's R - G, so that red amid red responds.
- `mended`: m is the mean of all other maxima, and the surround's R - G is subtracted, as T [41] means both.
- `zero_mean`: as `printed`, with Gabor kernels of sum zero. A plain Gabor kernel keeps 6 % of its envelope's sum, so
  that it responds to plain brightness. T names Gabor pyramids and prints no kernel.

N first scales a map to 0..1, as in T [41]: the units of the maps differ, and T states no other scale. A sum of N is
divided by the number of its terms, so that each map lies in 0..1. The scale of a map changes nothing in it.
T prints no parameters of the Gabor filters, the Laplacian and the median filter: they are those of our own formulas.
"""

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from haptic_glance.base.jit import cached_njit
from haptic_glance.base.lazy import cv2
from haptic_glance.mesh.mesh import Mesh

from ..views import View
from .colour import LINEAR, mechanisms
from .operators import CENTRES, DELTAS, expand, mean_of_maxima, mean_of_other_maxima, pyramid, reduce
from .texture import (
    ANGLES,
    EDGE_SIGMA,
    MEDIAN,
    SIDE,
    WINDOW,
    gabor_grid,
    laplacian_of_gaussian,
    local_variance,
    magnitude,
)

kernel = cached_njit()
OURS, PRINTED, MENDED, ZERO_MEAN = FORMULAS = ("ours", "printed", "mended", "zero_mean")
STORED = 2  # the scale of a map of a whole picture, a quarter of its size
Levels = dict[int, np.ndarray]
Channel = Callable[[Mesh, View, bool], np.ndarray]


def check_formulas(name: str, filled: bool) -> None:
    """Raises ValueError unless `name` is one of FORMULAS that goes with the background."""
    if name not in FORMULAS:
        raise ValueError(f"unknown formulas {name!r}: choose one of {', '.join(FORMULAS)}")
    if filled and name != OURS:
        remedy = "keep the background (filled=False, in the pipeline conspicuity.background=kept)"
        raise ValueError(f"the formulas {name} filter whole pictures: {remedy}")


def normalise(values: np.ndarray, mended: bool) -> np.ndarray:
    """N(.) of T3.1.1: a map (h, w) in 0..1, times (M - m)^2; m, the mean of the local maxima, without M if mended."""
    low, span = values.min(), np.ptp(values)
    if span == 0:
        return np.zeros(values.shape, dtype=np.float32)
    scaled = ((values - low) / span).astype(np.float32)
    return scaled * (1 - (mean_of_other_maxima(scaled, 0.0) if mended else mean_of_maxima(scaled))) ** 2


def centre_surround(levels: Levels, mended: bool, sign: int = 1) -> np.ndarray:
    """The across-scale mean of N(|I(c) - sign I(s)|) at scale 4 (T eq. 3.1): a map of six terms in 0..1."""
    terms = [
        reduce(normalise(np.abs(levels[c] - sign * expand(levels, c + delta, c)), mended), c)
        for c in CENTRES
        for delta in DELTAS
    ]
    return np.mean(terms, axis=0)


def intensity(_mesh: Mesh, view: View, mended: bool) -> np.ndarray:
    """T eq. 3.1."""
    return centre_surround(pyramid(_intensity(view)), mended)


def orientation(_mesh: Mesh, view: View, mended: bool, zero_mean: bool = False) -> np.ndarray:
    """T eq. 3.2, with the magnitude of the even and the odd response."""
    levels = {scale: level for scale, level in pyramid(_intensity(view)).items() if scale > 1}
    responses = [{scale: gabor(level, angle, zero_mean) for scale, level in levels.items()} for angle in ANGLES]
    return np.mean([normalise(centre_surround(response, mended), mended) for response in responses], axis=0)


def color(_mesh: Mesh, view: View, mended: bool) -> np.ndarray:
    """T eq. 3.3 to 3.5."""
    r, g, b = cv2.split(view.rgb.astype(np.float32) / np.float32(255))
    red, green, blue = r - (g + b) / 2, g - (r + b) / 2, b - (r + g) / 2
    yellow = (r + g) / 2 - np.abs(r - g) / 2 - b
    sign = 1 if mended else -1
    return np.mean([centre_surround(pyramid(plane), mended, sign) for plane in (red - green, blue - yellow)], axis=0)


def dkl(_mesh: Mesh, view: View, mended: bool) -> np.ndarray:
    """T eq. 3.6."""
    planes = cv2.split(mechanisms(LINEAR.astype(np.float32)[view.rgb]))
    return np.mean([centre_surround(pyramid(plane), mended) for plane in planes], axis=0)


def contrast(_mesh: Mesh, view: View, mended: bool) -> np.ndarray:
    """N of the variance of the luminance in 80 x 80 pixels (T3.1.1)."""
    side = max(round(WINDOW * len(view.rgb)), 3)
    return _stored(local_variance(_luminance(view), np.ones(view.mask.shape, dtype=bool), side), mended)


def entropy(_mesh: Mesh, view: View, mended: bool) -> np.ndarray:
    """N of the entropy of 9 x 9 pixels behind a median filter (T eq. 3.7)."""
    half = SIDE // 2
    padded = cv2.copyMakeBorder(cv2.medianBlur(_luminance(view), MEDIAN), half, half, half, half, cv2.BORDER_REFLECT)
    return _stored(window_entropy(padded, SIDE), mended)


def edge(_mesh: Mesh, view: View, mended: bool) -> np.ndarray:
    """N of the magnitude of the Laplacian of a Gaussian (T3.2)."""
    sigma = max(EDGE_SIGMA * len(view.rgb), 0.7)
    return _stored(np.abs(laplacian_of_gaussian(_luminance(view), sigma)), mended)


def gabor(image: np.ndarray, angle: float, zero_mean: bool) -> np.ndarray:
    """(h, w) f4: magnitude of the even and odd Gabor responses of an image at an angle in degrees.

    With `zero_mean`, the envelope is subtracted from the kernels in the share that makes their sums zero.
    """
    _, envelope, wave = gabor_grid(angle)
    envelope = envelope / envelope.sum()
    wave = envelope * wave
    if zero_mean:
        wave -= envelope * wave.sum()
    wave = wave.astype(np.complex64)
    return magnitude(image, (wave.real.copy(), wave.imag.copy()))


@kernel
def window_entropy(padded: np.ndarray, side: int) -> np.ndarray:
    """(h, w) f4 entropy in bits of the side x side windows of an image (h + side - 1, w + side - 1) u1 (T eq. 3.7)."""
    height, width, pixels = padded.shape[0] - side + 1, padded.shape[1] - side + 1, side * side
    shares = np.arange(pixels + 1) / pixels
    terms = -shares * np.log2(np.maximum(shares, 1 / pixels))
    entropy = np.empty((height, width), dtype=np.float32)
    for i in range(height):
        counts, total = np.zeros(256, dtype=np.int64), 0.0
        for a in range(i, i + side):
            for b in range(side):
                counts[padded[a, b]] += 1
        for count in counts:
            total += terms[count]
        entropy[i, 0] = total
        for j in range(1, width):
            for a in range(i, i + side):
                total += _moved(counts, terms, padded[a, j - 1], -1) + _moved(counts, terms, padded[a, j + side - 1], 1)
            entropy[i, j] = total
    return entropy


@kernel
def _moved(counts, terms, level, step):
    """The change of the entropy by a pixel of a level that leaves the window (-1) or enters it (1)."""
    before = terms[counts[level]]
    counts[level] += step
    return terms[counts[level]] - before


def printed_channels(channels: Mapping[str, Channel], formulas: str) -> dict[str, Channel]:
    """The channels by name, functions of (mesh, view, filled), with formulas of this module.

    Of a channel of the surface T prints no formula but C = N(map).
    """
    mended = formulas == MENDED
    picture = PICTURE | {"orientation": partial(orientation, zero_mean=formulas == ZERO_MEAN)}
    printed = {name: _of_picture(picture[name], mended) for name in channels if name in picture}
    return {
        **channels,
        **printed,
        **{name: _renormalised(channels[name], mended) for name in channels if name in SURFACE},
    }


def _of_picture(channel, mended):
    return lambda mesh, view, _filled: channel(mesh, view, mended)


def _renormalised(channel, mended):
    return lambda mesh, view, _filled: normalise(channel(mesh, view, False), mended)


def _intensity(view):
    return view.rgb.mean(axis=2, dtype=np.float32) / np.float32(255)


def _luminance(view):
    return cv2.cvtColor(view.rgb, cv2.COLOR_RGB2GRAY)


def _stored(values, mended):
    return reduce(normalise(values, mended), 0, STORED)


PICTURE = {
    "color": color,
    "contrast": contrast,
    "dkl": dkl,
    "edge": edge,
    "entropy": entropy,
    "intensity": intensity,
    "orientation": orientation,
}
SURFACE = ("curvature", "symmetry", "symmetry_lateral", "symmetry_radial")
