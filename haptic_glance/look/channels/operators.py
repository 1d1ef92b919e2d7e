"""The operators of Itti's model that the channels share: pyramids, centre-surround, N(.), across-scale addition.

Sources: T3.1.1; Itti, Koch and Niebur, A model of saliency-based visual attention for rapid scene analysis, IEEE PAMI
20(11), 1998 (T [41]), section 2. A pyramid is a dict scale -> image; pixel k of scale s lies on pixel k * 2**s of the
view, since pyrDown keeps the even pixels and pyrUp restores them, so maps do not shift between scales.
"""

import numpy as np

from haptic_glance.base.jit import cached_njit
from haptic_glance.base.lazy import cv2

kernel = cached_njit()
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


def mean_of_other_maxima(values: np.ndarray, least: float) -> float:
    """The mean of the local maxima above `least` of values (h, w) f4, without the highest; 0 if there is no other."""
    total, highest, count = _maxima(values, least)
    return (total - highest) / (count - 1) if count > 1 else 0.0


def mean_of_maxima(values: np.ndarray) -> float:
    """The mean of all local maxima of values (h, w) f4, 0 or more; 0 of an even map, which has none above zero."""
    total, _, count = _maxima(values, 0.0)
    return total / count if count else 0.0


@kernel
def _maxima(values: np.ndarray, least: float) -> tuple[float, float, int]:
    """(sum, highest, number) of the local maxima above `least` of values (h, w) f4.

    A local maximum is at least as high as its eight neighbours; a plateau counts as one.
    """
    height, width = values.shape
    total, highest, count = 0.0, 0.0, 0
    counted = np.zeros((height, width), dtype=np.bool_)
    for i in range(height):
        for j in range(width):
            if values[i, j] <= np.float32(least) or counted[i, j] or not _is_peak(values, i, j):
                continue
            total, highest, count = total + values[i, j], max(highest, values[i, j]), count + 1
            counted[i, j], plateau = True, [(i, j)]
            while len(plateau):
                a, b = plateau.pop()
                for r in range(max(a - 1, 0), min(a + 2, height)):
                    for c in range(max(b - 1, 0), min(b + 2, width)):
                        if values[r, c] == values[i, j] and not counted[r, c] and _is_peak(values, r, c):
                            counted[r, c] = True
                            plateau.append((r, c))
    return total, highest, count


@kernel
def _is_peak(values, i, j):
    for r in range(max(i - 1, 0), min(i + 2, values.shape[0])):
        for c in range(max(j - 1, 0), min(j + 2, values.shape[1])):
            if values[r, c] > values[i, j]:
                return False
    return True
