"""What of a point attracts gaze: its height, what sees it, its relief, and where it lies on the object."""

import numpy as np
from scipy import ndimage

from .mirror import symmetry
from .relief import fullness, relief
from .samples import Samples
from .visibility import visibility

RADII = 0.12, 0.24  # of fullness, in units of the bounding sphere's diameter
# name -> its standard deviation on a typical object: the median over 33 objects with human gaze, of the last two over
# those with a clear mirror plane. A feature that varies by less than half of this is not scaled up to deviation 1, so
# that noise on a sphere is not amplified.
FEATURES = {
    "rank": 0.29, "middle": 0.31, "upward": 0.53, "upward_high": 0.098, "seen": 0.11, "above": 0.16,
    "above_high": 0.047, "below": 0.15, "log_below": 1.0, "log_side": 0.7, "convexity": 0.12, "detail": 0.055,
    "relief": 0.065, "fullness_0.12": 0.23, "fullness_0.24": 0.27, "distance": 0.096, "distance_squared": 0.054,
    "outward": 0.49, "off_plane": 0.03, "on_plane": 0.2,
}  # fmt: skip
LEVELS, BLUR = 256, 4.0  # of height, and the deviation of the Gaussian over them that a rank is read from
MARGIN = 20  # levels below and above, which the Gaussian reaches
LIMIT = 4.0  # standard deviations; what lies farther out counts as this


def features(samples: Samples) -> dict[str, np.ndarray]:
    """dict name -> (s,) f8: the features, not yet standardised."""
    seen, side, above, below = visibility(samples)
    convexity, detail, around = relief(samples)
    off_plane, on_plane = symmetry(samples)
    away, upward = samples.local, samples.normals[:, 2]
    height, distance = away[:, 2], np.linalg.norm(away, axis=1)
    rank = _rank(height, samples.shares)
    return {
        "rank": rank, "middle": np.sin(np.pi * rank), "upward": upward, "upward_high": height * upward,
        "seen": seen, "above": above, "above_high": above * height, "below": below,
        "log_below": np.log(below + 0.02), "log_side": np.log(side + 0.01),
        "convexity": convexity, "detail": detail, "relief": around,
        **{f"fullness_{radius}": fullness(samples, radius) for radius in RADII},
        "distance": distance, "distance_squared": distance**2,
        "outward": np.einsum("ij,ij->i", samples.normals @ samples.axes.T, away) / np.maximum(distance, 1e-9),
        "off_plane": off_plane, "on_plane": on_plane,
    }  # fmt: skip


def _rank(height, shares):
    """(s,) the share of the surface that lies below each height, over which a flat top is spread evenly."""
    low, span = height.min(), max(float(np.ptp(height)), 1e-9)
    level = (height - low) / span * LEVELS + MARGIN
    amounts = np.bincount(np.rint(level).astype(np.int64), shares, minlength=LEVELS + 2 * MARGIN + 1)
    amounts = ndimage.gaussian_filter1d(amounts, BLUR, mode="constant")
    below = np.cumsum(amounts) - amounts / 2
    return np.interp(level, np.arange(len(below)), below)


def standardised(samples: Samples) -> dict[str, np.ndarray]:
    """dict name -> (s,) f8: the features with mean 0 and deviation 1, or less where one hardly varies."""
    found = {}
    for name, values in features(samples).items():
        centred = values - samples.shares @ values
        deviation = float(np.sqrt(samples.shares @ centred**2))
        found[name] = (centred / max(deviation, FEATURES[name] / 2)).clip(-LIMIT, LIMIT)
    return found
