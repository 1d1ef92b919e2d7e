"""Shaded frames, what structure they lose, and where they are off; `frames` is a stages.scene.Frames throughout."""

import numpy as np
from skimage.metrics import structural_similarity

from stages.lod.similarity import SIGMA, WINDOW, ssim_error

from .look import LUMA


def shaded(frames, frame, levels, only=None):
    """(h, w, 3) f8 rgb, 0 to 255, of a frame with a level an object.

    only: an object, in and around whose box alone the picture need be right.
    """
    h, w = frames.scene.cameras[frame].size
    image, depth = np.zeros((h * w, 3)), np.full(h * w, np.inf)
    for item, level in enumerate(levels):
        if only is not None and not _meet(frames, frame, only, item):
            continue
        seen = frames.look(frame, item, level)
        nearer = seen.depth < depth[seen.pixels]
        at = seen.pixels[nearer]
        depth[at], image[at] = seen.depth[nearer], frames.colors(frame, item, level)[nearer]
    return image.reshape(h, w, 3)


def picture(frames, frame, levels, only=None):
    """(h, w) f8 luminance, 0 to 255, of a frame; see `shaded`."""
    return shaded(frames, frame, levels, only) @ LUMA


def picture_error(frames, frame, levels):
    """1 - SSIM of the whole frame (Wang et al. 2004, T [63]) against the full one."""
    return ssim_error(picture(frames, frame, frames.full), picture(frames, frame, levels))


def structure_lost(frames, frame, item, one, other):
    """1 - SSIM between an object at two levels, the others at full detail: see `structures_lost`."""
    levels, shown, seen = list(frames.full), [], []
    for level in (one, other):
        levels[item] = level
        shown.append(picture(frames, frame, levels, only=item))
        seen.append(frames.look(frame, item, level).pixels[frames.visible(frame, item, level)])
    return _lost(frames, frame, item, *shown, np.union1d(*seen))


def structures_lost(frames, frame, levels):
    """(o,) mean of 1 - SSIM against the full frame, over the pixels in which each object is seen in either picture."""
    before, after = picture(frames, frame, frames.full), picture(frames, frame, levels)
    owners = [frames.owners(frame, shown) for shown in (frames.full, levels)]
    seen = [np.flatnonzero((owners[0] == item) | (owners[1] == item)) for item in range(len(levels))]
    return np.array([_lost(frames, frame, item, before, after, pixels) for item, pixels in enumerate(seen)])


def displacement_picture(frames, frame, levels):
    """(h, w) f4 displacement in pixels of what a frame with these levels shows, NaN where it shows nothing."""
    owner = frames.owners(frame, levels)
    image = np.full(owner.shape, np.nan, np.float32)
    for item, level in enumerate(levels):
        pixels = frames.look(frame, item, level).pixels
        mine = owner[pixels] == item
        image[pixels[mine]] = frames.displacements(frame, item, level)[mine]
    return image.reshape(frames.scene.cameras[frame].size)


def _lost(frames, frame, item, before, after, pixels):
    """Mean of 1 - SSIM of two pictures over pixels of an object, in and around whose box they are right."""
    if not len(pixels):
        return 0.0
    box = _padded(frames, frame, item)
    _, alike = structural_similarity(
        before[box], after[box], win_size=WINDOW, gaussian_weights=True, sigma=SIGMA, use_sample_covariance=False,
        data_range=255, full=True,
    )  # fmt: skip
    lost = np.zeros(before.shape)
    lost[box] = 1 - alike
    return float(lost.ravel()[pixels].mean())


def _padded(frames, frame, item):
    """The object's box with room for the window on all sides, where the screen has it."""
    h, w = frames.scene.cameras[frame].size
    top, bottom, left, right = frames.boxes[frame][item]
    rows = slice(max(min(top, h - WINDOW) - WINDOW, 0), min(max(bottom, WINDOW) + WINDOW, h))
    return rows, slice(max(min(left, w - WINDOW) - WINDOW, 0), min(max(right, WINDOW) + WINDOW, w))


def _meet(frames, frame, one, other):
    (rows, columns), (top, bottom, left, right) = _padded(frames, frame, one), frames.boxes[frame][other]
    return rows.start < bottom and top < rows.stop and columns.start < right and left < columns.stop
