"""From maps of the crops at scale 4 to maps of the views at the size asked for."""

import numpy as np
import torch

from ..operators import COMMON
from .grid import Grid

FINEST = 2  # the scale from which the maps are sampled, as stages.conspicuity.channels.fit does


def fit(stack, maps, size):
    """(v, c, *size) f4 of the maps (v, c, h, w) of the crops at scale 4, smoothly, zero around the crop."""
    whole = Grid([stack.view_shape] * len(maps), stack.device)
    maps = whole.expand(_framed(stack, maps, whole.shape(COMMON)), COMMON, FINEST)
    for dim, side, wanted in ((2, stack.view_shape[0], size[0]), (3, stack.view_shape[1], size[1])):
        ratio = side / wanted
        at = (np.arange(wanted) * ratio + (ratio - 1) / 2) / 2**FINEST
        maps = _sampled(maps, dim, at)
    return maps


def _framed(stack, maps, shape):
    """The maps of the crops set into maps (v, c, *shape) of the whole views."""
    for dim, corner in ((2, stack.corners[:, 0]), (3, stack.corners[:, 1])):
        at = np.arange(shape[dim - 2]) - (corner >> COMMON)[:, None]
        inside = torch.from_numpy((at >= 0) & (at < maps.shape[dim])).to(stack.device)[:, None, :, None]
        at = torch.from_numpy(at.clip(0, maps.shape[dim] - 1)).to(stack.device)[:, None, :, None]
        at, inside = at.transpose(2, dim), inside.transpose(2, dim)
        sides = [*maps.shape[:2], *(at.shape[k] if k == dim else maps.shape[k] for k in (2, 3))]
        maps = torch.where(inside, maps.gather(dim, at.expand(sides)), 0)
    return maps


def _sampled(maps, dim, at):
    """Maps at fractional places (k,) along a dimension, linearly, the ends repeated."""
    low, last = np.floor(at), maps.shape[dim] - 1
    ends = [torch.from_numpy(k.clip(0, last).astype(np.int64)).to(maps.device) for k in (low, low + 1)]
    share = torch.from_numpy((at - low).astype(np.float32)).to(maps.device)
    share = share.view(-1, 1) if dim == 2 else share
    return maps.index_select(dim, ends[0]) * (1 - share) + maps.index_select(dim, ends[1]) * share
