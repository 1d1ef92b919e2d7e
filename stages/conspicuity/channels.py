"""The channels by name, and all their maps of one view at one size."""

import cv2
import numpy as np

from .color import color
from .contrast import contrast
from .curvature import curvature
from .dkl import dkl
from .edge import edge
from .entropy import entropy
from .fine_grained import fine_grained
from .intensity import intensity
from .operators import COMMON
from .orientation import orientation
from .spectral_residual import spectral_residual
from .symmetry import symmetry, symmetry_lateral, symmetry_radial

CHANNELS = {
    "color": color,
    "contrast": contrast,
    "curvature": curvature,
    "dkl": dkl,
    "edge": edge,
    "entropy": entropy,
    "intensity": intensity,
    "orientation": orientation,
    "symmetry": symmetry,
}
# Beside the nine of T table 3.1: symmetry of either kind alone (T3.1.5), and two rivals out of OpenCV.
OTHERS = {
    "symmetry_lateral": symmetry_lateral,
    "symmetry_radial": symmetry_radial,
    "spectral_residual": spectral_residual,
    "fine_grained": fine_grained,
}
SHARE = 4  # the default size of a map: a quarter of the view's


def conspicuity(mesh, view, channels=None, size=None, filled=True):
    """The conspicuity maps of a view: {channel: (h', w') f4 in 0..1}, zero off the object.

    mesh: stages.kit.Mesh; view: stages.views.View of it; channels: names out of CHANNELS and OTHERS, None for
    the nine of CHANNELS; size: (rows, columns) of the maps, by default a quarter of the view's; filled: True keeps the
    background out of the filters (stages.conspicuity.background), False shows what it would do there. The two rivals
    out of OpenCV see the image as rendered in either case.

    Every map of a channel has gone through N(.) once more as a whole, the way Itti 1998 brings channels to one scale
    before their sum: its highest value says how much it stands out. Raises ValueError for an unknown channel, a size
    without pixels, or a view that is not of this mesh.
    """
    names = list(CHANNELS) if channels is None else known_channels(channels)
    size = tuple(max(side // SHARE, 1) for side in view.mask.shape) if size is None else tuple(size)
    if len(size) != 2 or min(size) < 1:
        raise ValueError(f"the size of the maps must be (rows, columns), each at least 1, got {size}")
    inside = coverage(view.mask, size)
    maps = CHANNELS | OTHERS
    return {name: fit(maps[name](mesh, view, filled), view.mask.shape, size) * inside for name in names}


def known_channels(names):
    """The names as a list; ValueError when one is neither in CHANNELS nor in OTHERS."""
    known = [*CHANNELS, *OTHERS]
    unknown = [name for name in names if name not in known]
    if unknown:
        raise ValueError(f"unknown channel {', '.join(map(str, unknown))}: choose from {', '.join(known)}")
    return list(names)


def coverage(mask, size):
    """(rows, columns) boolean: at least half of the pixel's area is on the object."""
    return cv2.resize(mask.astype(np.float32), size[::-1], interpolation=cv2.INTER_AREA) >= 0.5


def fit(values, shape, size):
    """A channel's map, on the pyramid grid of a view of `shape`, at another size (h', w'), smoothly.

    Pixel k of the map lies on pixel k * 2**scale of the view, pixel j of the result covers an even share of the view.
    """
    sides = [tuple(-(-side // 2**s) for side in shape) for s in range(COMMON + 1)]
    scale = max(s for s in range(COMMON + 1) if sides[s] == values.shape)
    for finer in range(scale - 1, 1, -1):
        values = cv2.pyrUp(values, dstsize=sides[finer][::-1])
    step = 2 ** min(scale, 2)
    ratio = np.array(shape[::-1]) / np.array(size[::-1])
    ahead = (ratio - 1) / 2 / step
    matrix = np.array([[ratio[0] / step, 0, ahead[0]], [0, ratio[1] / step, ahead[1]]])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    return cv2.warpAffine(values, matrix, size[::-1], flags=flags, borderMode=cv2.BORDER_REPLICATE)
