"""N(.) and centre-surround on tensors, as in stages.conspicuity.operators."""

import torch
from torch.nn import functional

from ..operators import CENTRES, DELTAS, OUTPUT_SCALE, PEAK
from .grid import Grid


def centre_surround(
    grid: Grid,
    levels: dict[int, torch.Tensor],
    cover: dict[int, torch.Tensor],
    floors: torch.Tensor,
    on_centre: torch.Tensor,
) -> torch.Tensor:
    """Across-scale sum of N(|I(c) - I(s)|) at scale 4: (v, c, h, w).

    levels {2..8: (v, c, h, w) f4}; cover {2..4: (v, 1, h, w) boolean}; floors (c,), see `normalise`; on_centre (c,)
    boolean: maps in which a centre below its surround counts as zero.
    """
    total, rectified = torch.zeros_like(levels[OUTPUT_SCALE]), on_centre.repeat(len(DELTAS))[:, None, None]
    for c in CENTRES:
        surrounds = torch.cat([grid.expand(levels[c + delta], c + delta, c) for delta in DELTAS], 1)
        differences = levels[c].repeat(1, len(DELTAS), 1, 1) - surrounds
        differences = torch.where(rectified, differences.clamp(min=0), differences.abs())
        maps = grid.reduce(normalise(differences, cover[c], floors.repeat(len(DELTAS))), c, OUTPUT_SCALE)
        for part in maps.chunk(len(DELTAS), 1):
            total = total + part
    return total


def normalise(maps: torch.Tensor, cover: torch.Tensor, floors: torch.Tensor) -> torch.Tensor:
    """N(.) of every map (v, c, h, w) f4 over cover (v, 1, h, w) boolean, as stages.conspicuity.operators.normalise.

    A map whose range stays within its floor, of floors (c,), is zero.
    """
    high = torch.where(cover, maps, -torch.inf).amax((2, 3), keepdim=True)
    low = torch.where(cover, maps, torch.inf).amin((2, 3), keepdim=True)
    alive = cover & (high - low > floors[:, None, None])
    scaled = torch.where(alive, (maps - low) / (high - low), 0)
    return scaled * ((1 - mean_of_other_maxima(scaled)) ** 2).float()


def mean_of_other_maxima(scaled: torch.Tensor) -> torch.Tensor:
    """(v, c, 1, 1) f8: the mean of each map's local maxima above a tenth, without the highest; 0 if there is none."""
    tops = (scaled >= functional.max_pool2d(scaled, 3, 1, 1)) & (scaled > PEAK)
    heights = torch.where(one_per_plateau(tops), scaled, 0).double()
    count = (heights > 0).sum((2, 3), keepdim=True)
    others = heights.sum((2, 3), keepdim=True) - heights.amax((2, 3), keepdim=True)
    return torch.where(count > 1, others / (count - 1).clamp(min=1), 0)


def one_per_plateau(tops: torch.Tensor) -> torch.Tensor:
    """True at one pixel of every 8-connected region of tops (v, c, h, w) boolean.

    Each pixel takes the highest label around it, then the current label of the pixel with that label, so that a region
    of n pixels agrees after about log n iterations. Most maxima are single pixels, and need one iteration.
    """
    own = torch.arange(1, tops[0, 0].numel() + 1, dtype=torch.float32, device=tops.device)  # exact to 2**24
    own = own.view(tops.shape[2:]) * tops
    labels, earlier = own, None
    while earlier is None or not torch.equal(labels, earlier):
        earlier = labels
        spread = (functional.max_pool2d(labels, 3, 1, 1) * tops).flatten(2)
        labels = spread.gather(2, (spread.long() - 1).clamp(min=0)).view_as(own) * tops
    return tops & (labels == own)
