"""Places maps of the crops at scale 4 in maps of the views, at another size."""

import numpy as np
import torch

from ..operators import OUTPUT_SCALE
from .grid import Grid
from .stack import Stack

FINEST = 2  # the scale from which the maps are sampled, as stages.conspicuity.channels.resize_map does


def resize_maps(stack: Stack, maps: torch.Tensor, size: tuple[int, int]) -> torch.Tensor:
    """(v, c, *size) f4 of the maps (v, c, h, w) of the crops at scale 4, interpolated, zero around the crop."""
    whole = Grid([stack.view_shape] * len(maps), stack.device)
    maps = whole.expand(_placed_in_view(stack, maps, whole.shape(OUTPUT_SCALE)), OUTPUT_SCALE, FINEST)
    for dim, side, wanted in ((2, stack.view_shape[0], size[0]), (3, stack.view_shape[1], size[1])):
        ratio = side / wanted
        at = (np.arange(wanted) * ratio + (ratio - 1) / 2) / 2**FINEST
        maps = _sampled(maps, dim, at)
    return maps


def _placed_in_view(stack, maps, shape):
    """The maps of the crops as maps (v, c, *shape) of the whole views."""
    for dim, corner in ((2, stack.corners[:, 0]), (3, stack.corners[:, 1])):
        at = np.arange(shape[dim - 2]) - (corner >> OUTPUT_SCALE)[:, None]
        inside = torch.from_numpy((at >= 0) & (at < maps.shape[dim])).to(stack.device)[:, None, :, None]
        at = torch.from_numpy(at.clip(0, maps.shape[dim] - 1)).to(stack.device)[:, None, :, None]
        at, inside = at.transpose(2, dim), inside.transpose(2, dim)
        sides = [*maps.shape[:2], *(at.shape[k] if k == dim else maps.shape[k] for k in (2, 3))]
        maps = torch.where(inside, maps.gather(dim, at.expand(sides)), 0)
    return maps


def _sampled(maps, dim, at):
    """Maps at fractional positions (k,) along a dimension, linearly interpolated, the borders replicated."""
    low, last = np.floor(at), maps.shape[dim] - 1
    ends = [torch.from_numpy(k.clip(0, last).astype(np.int64)).to(maps.device) for k in (low, low + 1)]
    share = torch.from_numpy((at - low).astype(np.float32)).to(maps.device)
    share = share.view(-1, 1) if dim == 2 else share
    return maps.index_select(dim, ends[0]) * (1 - share) + maps.index_select(dim, ends[1]) * share
