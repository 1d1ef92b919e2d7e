"""The part of a view that holds the object, made ready once for all channels: cropped, filled, in pyramids."""

from functools import cached_property

import cv2
import numpy as np

from .background import fill
from .memo import once
from .operators import COMMON, pyramid

GRID = 2**COMMON  # the crop starts on this grid, so that its pyramid pixels are pixels of the whole view's pyramid
MARGIN = 32  # pixels kept around the object, so that a filter at scale 4 meets the filled background, not the border
RIM = 5 / 900  # of the image's rows: where the head light fades to the silhouette, which is background already
COVERED = 0.1  # a pyramid pixel is on the object when this share of its footprint is: thin rims must not vanish


@once
def picture(view, filled=True):
    """The Picture of a view, shared by its channels. filled=False leaves the background as rendered (to compare).

    Raises ValueError when the view's rgb is not of 8-bit levels.
    """
    if view.rgb.dtype != np.uint8:
        raise ValueError(f"a view's rgb must hold 8-bit levels (uint8), got {view.rgb.dtype}")
    return Picture(view.rgb, view.mask, filled)


class Picture:
    """The object's crop of a view: rgb (h, w, 3) u1 with rim and background filled, and pyramids of it.

    mask (h, w) boolean: the pixel is on the object; known (h, w) boolean: its grey is the object's own, not filled.
    """

    def __init__(self, rgb, mask, filled):
        self.shape = mask.shape
        self.box = _box(mask)
        self.mask = np.ascontiguousarray(mask[self.box])
        if self.empty:
            return
        self.known = core(self.mask, max(round(RIM * len(mask)), 1)) if filled else np.ones_like(self.mask)
        rgb = rgb[self.box]
        self.grey_only = bool((rgb[self.mask][:, :1] == rgb[self.mask]).all())
        planes = rgb[..., 0] if self.grey_only else rgb
        self._planes = _fill_bytes(planes, self.known) if filled else np.ascontiguousarray(planes)

    @property
    def empty(self):
        """No pixel is on the object."""
        return self.mask.size == 0

    @cached_property
    def rgb(self):
        """(h, w, 3) u1."""
        return cv2.merge([self._planes] * 3) if self.grey_only else self._planes

    @cached_property
    def intensity(self):
        """(h, w) f4 in 0..1: (r + g + b) / 3 (T3.1.1)."""
        planes = (
            self._planes if self.grey_only else cv2.transform(self._planes.astype(np.float32), np.full((1, 3), 1 / 3))
        )
        return planes.astype(np.float32) / np.float32(255)

    @cached_property
    def luminance(self):
        """(h, w) u1: luma of ITU-R BT.601, the grey image of most imaging tools."""
        return self._planes if self.grey_only else cv2.cvtColor(self._planes, cv2.COLOR_RGB2GRAY)

    @cached_property
    def intensity_pyramid(self):
        """{0..8: (h, w) f4}."""
        return pyramid(self.intensity)

    @cached_property
    def cover(self):
        """{0..4: (h, w) boolean}: where the object is, at each scale."""
        shares = pyramid(self.mask.astype(np.float32), last=COMMON)
        return {scale: share > COVERED for scale, share in shares.items()}

    def whole(self, crop, scale):
        """A map of the crop at a scale, set into a map of the whole view at that scale, zero around it."""
        size = [-(-side // 2**scale) for side in self.shape]
        framed = np.zeros(size, dtype=np.float32)
        top, left = self.box[0].start >> scale, self.box[1].start >> scale
        framed[top : top + crop.shape[0], left : left + crop.shape[1]] = crop
        return framed

    def nothing(self):
        """The map of a channel that has nothing to say."""
        return np.zeros([-(-side // GRID) for side in self.shape], dtype=np.float32)


def core(mask, rim):
    """(h, w) boolean: the mask without its outermost `rim` pixels; parts that would vanish stay as they are."""
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * rim + 1, 2 * rim + 1))
    inner = cv2.erode(mask.astype(np.uint8), disc, borderType=cv2.BORDER_CONSTANT, borderValue=0)
    thick = cv2.dilate(cv2.dilate(inner, disc), np.ones((3, 3), np.uint8))
    return (inner > 0) | (mask & (thick == 0))


def _box(mask):
    """Slices of the object's bounding box with its margin, starting on the grid; empty slices without object."""
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
