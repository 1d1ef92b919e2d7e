"""The operators of Itti's model that the channels share: pyramids, centre-surround, N(.), across-scale addition.

Sources: T3.1.1; Itti, Koch and Niebur, A model of saliency-based visual attention for rapid scene analysis, IEEE PAMI
20(11), 1998 (T [41]), section 2. A pyramid is a dict scale -> image; pixel k of scale s lies on pixel k * 2**s of the
view, since pyrDown keeps the even pixels and pyrUp restores them, so maps do not shift between scales.
"""

import numpy as np

from haptic_glance.base.lazy import cv2

from .kernels import mean_of_other_maxima

SCALES = 9
CENTRES = (2, 3, 4)
DELTAS = (3, 4)
OUTPUT_SCALE = 4  # the scale to which across-scale addition reduces its maps
FLOOR = 1e-3  # a quarter of a grey level of an 8-bit image; below it a map is only rounding
PEAK = 0.1  # local maxima under a tenth of the highest do not count, as in Walther and Koch's SaliencyToolbox, 2006


def down(image: np.ndarray) -> np.ndarray:
    """Gaussian blur (5 x 5, binomial), then every second pixel: (h, w) to (ceil(h / 2), ceil(w / 2))."""
    return cv2.pyrDown(image, borderType=cv2.BORDER_REPLICATE)


def pyramid(image: np.ndarray, first: int = 0, last: int = SCALES - 1) -> dict[int, np.ndarray]:
    """The dyadic Gaussian pyramid {first: image, ..., last: ...} of an image given at scale `first`."""
    levels = {first: image}
    for scale in range(first, last):
        levels[scale + 1] = down(levels[scale])
    return levels


def reduce(image: np.ndarray, scale: int, target: int = OUTPUT_SCALE) -> np.ndarray:
    """The image, given at a scale, at the coarser scale `target`."""
    for _ in range(scale, target):
        image = down(image)
    return image


def expand(levels: dict[int, np.ndarray], scale: int, target: int) -> np.ndarray:
    """Level `scale` of a pyramid interpolated to the grid of its finer level `target`."""
    image = levels[scale]
    for finer in range(scale - 1, target - 1, -1):
        h, w = levels[finer].shape
        image = cv2.pyrUp(image, dstsize=(w, h))
    return image


def centre_surround(
    levels: dict[int, np.ndarray], cover: dict[int, np.ndarray], floor: float = FLOOR, on_centre: bool = False
) -> np.ndarray:
    """Across-scale sum of N(|I(c) - I(s)|) at scale 4, the inner part of T eq. 3.1.

    levels: pyramid {2..8: (h, w) f4}; cover: pyramid {2..4: (h, w) boolean}, where the object is; floor: see
    `normalise`. Six terms, c in {2, 3, 4} and s = c + {3, 4}. on_centre: a centre below its surround counts as
    zero, as in a cell that its surround inhibits (T3.1.1), instead of as much as one above it.
    """
    total = np.zeros(levels[OUTPUT_SCALE].shape, dtype=np.float32)
    for c in CENTRES:
        for delta in DELTAS:
            surround = expand(levels, c + delta, c)
            difference = np.maximum(levels[c] - surround, 0) if on_centre else cv2.absdiff(levels[c], surround)
            total += reduce(normalise(difference, cover[c], floor), c)
    return total


def normalise(values: np.ndarray, cover: np.ndarray, floor: float = FLOOR) -> np.ndarray:
    """N(.): scales a map to 0..1 over the object and multiplies it by (M - m)^2 = (1 - m)^2; zero off the object.

    m is the mean of all local maxima except the highest one. T3.1.1 says "all", its source (Itti 1998, section 2.1)
    "all other", without which a single peak, which N should promote, would be removed. A map whose range is at most
    `floor` is flat: all zero. values (h, w) f4, cover (h, w) boolean.
    """
    inside = values[cover]
    low, high = (inside.min(), inside.max()) if len(inside) else (0, 0)
    if high - low <= floor:
        return np.zeros(values.shape, dtype=np.float32)
    scaled = np.where(cover, (values - low) / (high - low), 0).astype(np.float32)
    return scaled * (1 - mean_of_other_maxima(scaled, PEAK)) ** 2
