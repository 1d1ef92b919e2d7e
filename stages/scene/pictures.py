"""Shaded frames, their structural errors, and their displacements."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from stages.kit.similarity import WINDOW, ssim_map
from stages.lod.similarity import ssim_error

from .lod_chain import Level
from .rendering import LUMA

if TYPE_CHECKING:
    from .frames import Frames  # which imports this module


def shaded(frames: "Frames", frame: int, levels: Sequence[Level], only: int | None = None) -> np.ndarray:
    """(h, w, 3) f8 rgb, 0 to 255, of a frame with one level per object.

    only: an object, outside of whose box the picture may be incomplete.
    """
    h, w = frames.scene.cameras[frame].size
    image, depth = np.zeros((h * w, 3)), np.full(h * w, np.inf)
    for item, level in enumerate(levels):
        if only is not None and not _overlap(frames, frame, only, item):
            continue
        own = frames.rendering(frame, item, level)
        nearer = own.depth < depth[own.pixels]
        at = own.pixels[nearer]
        depth[at], image[at] = own.depth[nearer], frames.colors(frame, item, level)[nearer]
    return image.reshape(h, w, 3)


def picture(frames: "Frames", frame: int, levels: Sequence[Level], only: int | None = None) -> np.ndarray:
    """(h, w) f8 luminance, 0 to 255, of a frame; see `shaded`."""
    return shaded(frames, frame, levels, only) @ LUMA


def picture_error(frames: "Frames", frame: int, levels: Sequence[Level]) -> float:
    """1 - SSIM of the whole frame (Wang et al. 2004, T [63]) against the full one."""
    return ssim_error(picture(frames, frame, frames.full), picture(frames, frame, levels))


def structure_lost(frames: "Frames", frame: int, item: int, one: Level, other: Level) -> float:
    """1 - SSIM between an object at two levels, the others at full detail: see `structures_lost`."""
    levels, shown, visible = list(frames.full), [], []
    for level in (one, other):
        levels[item] = level
        shown.append(picture(frames, frame, levels, only=item))
        visible.append(frames.rendering(frame, item, level).pixels[frames.visible(frame, item, level)])
    return _lost(frames, frame, item, shown[0], shown[1], np.union1d(visible[0], visible[1]))


def structures_lost(frames: "Frames", frame: int, levels: Sequence[Level]) -> np.ndarray:
    """(o,) mean of 1 - SSIM against the full frame, over the pixels that show each object in either picture."""
    before, after = picture(frames, frame, frames.full), picture(frames, frame, levels)
    owners = [frames.owners(frame, shown) for shown in (frames.full, levels)]
    own = [np.flatnonzero((owners[0] == item) | (owners[1] == item)) for item in range(len(levels))]
    return np.array([_lost(frames, frame, item, before, after, pixels) for item, pixels in enumerate(own)])


def displacement_picture(frames: "Frames", frame: int, levels: Sequence[Level]) -> np.ndarray:
    """(h, w) f4 displacement in pixels of what a frame with these levels shows, NaN where it shows nothing."""
    owner = frames.owners(frame, levels)
    image = np.full(owner.shape, np.nan, np.float32)
    for item, level in enumerate(levels):
        pixels = frames.rendering(frame, item, level).pixels
        mine = owner[pixels] == item
        image[pixels[mine]] = frames.displacements(frame, item, level)[mine]
    return image.reshape(frames.scene.cameras[frame].size)


def _lost(frames, frame, item, before, after, pixels):
    """Mean of 1 - SSIM of two pictures over pixels of an object; outside of its box they may be incomplete."""
    if not len(pixels):
        return 0.0
    box = _padded(frames, frame, item)
    lost = np.zeros(before.shape)
    lost[box] = 1 - ssim_map(before[box], after[box])
    return float(lost.ravel()[pixels].mean())


def _padded(frames, frame, item):
    """The object's box padded by the window on all sides, within the screen."""
    h, w = frames.scene.cameras[frame].size
    top, bottom, left, right = frames.boxes[frame][item]
    rows = slice(max(min(top, h - WINDOW) - WINDOW, 0), min(max(bottom, WINDOW) + WINDOW, h))
    return rows, slice(max(min(left, w - WINDOW) - WINDOW, 0), min(max(right, WINDOW) + WINDOW, w))


def _overlap(frames, frame, one, other):
    (rows, columns), (top, bottom, left, right) = _padded(frames, frame, one), frames.boxes[frame][other]
    return rows.start < bottom and top < rows.stop and columns.start < right and left < columns.stop
