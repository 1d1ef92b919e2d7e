"""The part of a view that shows the object, prepared for all channels: cropped, filled, and in pyramids."""

from functools import cached_property

import cv2
import numpy as np

from stages.views import View

from .background import fill
from .operators import OUTPUT_SCALE, pyramid
from .weak_cache import weak_cache

GRID = 2**OUTPUT_SCALE  # the crop starts on this grid, so that its pyramid is part of the pyramid of the view
MARGIN = 32  # pixels around the object, so that a filter at scale 4 sees the filled background, not the border
SILHOUETTE_BAND = 5 / 900  # of the image's rows: where shading fades to the silhouette; treated as background
COVERED = 0.1  # share of its footprint for a pyramid pixel to be on the object; keeps thin structures


@weak_cache
def cropped_view(view: View, filled: bool = True) -> "CroppedView":
    """The CroppedView of a view, shared by its channels. filled=False leaves the background as rendered.

    Raises ValueError when the rgb of the view is not of type uint8.
    """
    if view.rgb.dtype != np.uint8:
        raise ValueError(f"the rgb of a view must be of type uint8, got {view.rgb.dtype}")
    return CroppedView(view.rgb, view.mask, filled)


class CroppedView:
    """The crop of a view around the object: rgb (h, w, 3) u1 with silhouette and background filled, and pyramids.

    mask (h, w) boolean: the pixel is on the object; known (h, w) boolean: its colour is as rendered, not filled.
    """

    def __init__(self, rgb: np.ndarray, mask: np.ndarray, filled: bool) -> None:
        self.shape = mask.shape
        self.box = _box(mask)
        self.mask = np.ascontiguousarray(mask[self.box])
        if self.empty:
            return
        self.known = core(self.mask, max(round(SILHOUETTE_BAND * len(mask)), 1)) if filled else np.ones_like(self.mask)
        rgb = rgb[self.box]
        red, green, blue = (rgb[..., k] for k in range(3))
        self.grey_only = not (((red != green) | (red != blue)) & self.mask).any()
        planes = rgb[..., 0] if self.grey_only else rgb
        self._planes = _fill_bytes(planes, self.known) if filled else np.ascontiguousarray(planes)

    @property
    def empty(self) -> bool:
        """No pixel is on the object."""
        return self.mask.size == 0

    @cached_property
    def rgb(self) -> np.ndarray:
        """(h, w, 3) u1."""
        return cv2.merge([self._planes] * 3) if self.grey_only else self._planes

    @cached_property
    def intensity(self) -> np.ndarray:
        """(h, w) f4 in 0..1: (r + g + b) / 3 (T3.1.1)."""
        planes = (
            self._planes if self.grey_only else cv2.transform(self._planes.astype(np.float32), np.full((1, 3), 1 / 3))
        )
        return planes.astype(np.float32) / np.float32(255)

    @cached_property
    def luminance(self) -> np.ndarray:
        """(h, w) u1: luma of ITU-R BT.601, the usual grey image."""
        return self._planes if self.grey_only else cv2.cvtColor(self._planes, cv2.COLOR_RGB2GRAY)

    @cached_property
    def intensity_pyramid(self) -> dict[int, np.ndarray]:
        """{0..8: (h, w) f4}."""
        return pyramid(self.intensity)

    @cached_property
    def cover(self) -> dict[int, np.ndarray]:
        """{0..4: (h, w) boolean}: where the object is, at each scale."""
        shares = pyramid(self.mask.astype(np.float32), last=OUTPUT_SCALE)
        return {scale: share > COVERED for scale, share in shares.items()}

    def place_in_view(self, crop: np.ndarray, scale: int) -> np.ndarray:
        """A map of the crop at a scale as a map of the whole view at that scale, zero around the crop."""
        size = [-(-side // 2**scale) for side in self.shape]
        framed = np.zeros(size, dtype=np.float32)
        top, left = self.box[0].start >> scale, self.box[1].start >> scale
        framed[top : top + crop.shape[0], left : left + crop.shape[1]] = crop
        return framed

    def zero_map(self) -> np.ndarray:
        """A map of the view at the output scale that is zero everywhere."""
        return np.zeros([-(-side // GRID) for side in self.shape], dtype=np.float32)


def core(mask: np.ndarray, band: int) -> np.ndarray:
    """(h, w) boolean: the mask without its outermost `band` pixels; parts that would vanish stay unchanged."""
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * band + 1, 2 * band + 1))
    inner = cv2.erode(mask.astype(np.uint8), disc, borderType=cv2.BORDER_CONSTANT, borderValue=0)
    thick = cv2.dilate(cv2.dilate(inner, disc), np.ones((3, 3), np.uint8))
    return (inner > 0) | (mask & (thick == 0))


def _box(mask):
    """Slices of the object's bounding box with a margin, starting on the grid; empty slices without an object."""
    slices = []
    for axis in (1, 0):
        on = np.flatnonzero(mask.any(axis=axis))
        if not len(on):
            return slice(0, 0), slice(0, 0)
        start = max(on[0] - MARGIN, 0) // GRID * GRID
        slices.append(slice(start, min(on[-1] + 1 + MARGIN, len(mask) if axis else mask.shape[1])))
    return tuple(slices)


def _fill_bytes(planes, mask):
    return np.rint(fill(planes.astype(np.float32), mask)).astype(np.uint8)
