"""A view of an object as the maps show it: which one, its picture, and the part that holds the object."""

import numpy as np

from stages.report.drawing import VIEWPOINT, picture

MARGIN = 4  # pixels kept round the object


def nearest(viewpoints, among):
    """Of the view numbers `among` the one nearest to the other figures' viewpoint."""
    return max(among, key=lambda k: viewpoints[k].axes[2] @ VIEWPOINT.axes[2])


def render_like(mesh, viewpoint, shape):
    """(h, w, 3) f8 in 0..1: the object as a map of that shape shows it, on white."""
    render = picture(mesh, viewpoint=viewpoint, rows=shape[0])
    side = (shape[1] - shape[0]) // 2
    return np.pad(render, ((0, 0), (side, shape[1] - shape[0] - side), (0, 0)), constant_values=1.0)


def window(mask):
    """The slices of the rows and columns that hold the object (mask (h, w) boolean)."""
    down, across = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return tuple(slice(max(ids[0] - MARGIN, 0), ids[-1] + MARGIN + 1) for ids in (down, across))


def squared_window(mask):
    """As window, with sides of equal length where the map is large enough, so that panels have one size."""
    parts = window(mask)
    side = max(part.stop - part.start for part in parts)
    return tuple(_widened(part, side, length) for part, length in zip(parts, mask.shape, strict=True))


def _widened(part, side, length):
    start = int(np.clip((part.start + part.stop - side) // 2, 0, max(length - side, 0)))
    return slice(start, start + side)
