"""The channels that use the image alone, on a Stack: pyramids of planes, or maps at scale 4.

Each function computes what the function of the same name in stages.conspicuity does before N(.); see there for sources.
"""

import functools

import cv2
import numpy as np
import torch
from torch.nn import functional

from ..contrast import WINDOW
from ..dkl import FIRST, LINEAR, MECHANISMS
from ..edge import SIGMA
from ..entropy import MEDIAN, PLOGP, SCALE, SIDE
from ..operators import CENTRES, DELTAS, SCALES
from ..orientation import ANGLES, GAIN, RADIUS, gabor
from .stack import Stack

LAST = SCALES - 1


def intensity(stack: Stack) -> dict[int, torch.Tensor]:
    """{2..8: (v, 1, h, w)}."""
    return stack.intensity


def color(stack: Stack) -> dict[int, torch.Tensor]:
    """{2..8: (v, 2, h, w)}: red against green and blue against yellow."""
    if stack.grey:
        return stack.grid.pyramid(torch.zeros_like(stack.planes), 0, LAST)
    r, g, b = (stack.planes / 255).unbind(1)
    red, green, blue = ((a - (c + d) / 2).clamp(min=0) for a, c, d in ((r, g, b), (g, r, b), (b, r, g)))
    yellow = ((r + g) / 2 - (r - g).abs() / 2 - b).clamp(min=0)
    return stack.grid.pyramid(torch.stack([red - green, blue - yellow], 1), 0, LAST)


def dkl(stack: Stack) -> dict[int, torch.Tensor]:
    """{2..8: (v, 1 or 3, h, w)}: the three mechanisms, or luminance alone without hues."""
    linear = torch.from_numpy(LINEAR.astype(np.float32)).to(stack.device)[stack.planes.long()]
    linear = stack.grid.reduce(linear, 0, FIRST)
    if not stack.grey:
        rows = torch.from_numpy(MECHANISMS.astype(np.float32)).to(stack.device)
        linear = functools.reduce(torch.add, (rows[:, k, None, None] * linear[:, k : k + 1] for k in range(3)))
    return stack.grid.pyramid(linear, FIRST, LAST)


def orientation(stack: Stack) -> dict[int, torch.Tensor]:
    """{2..8: (v, 4, h, w)}: the Gabor energies of the four angles."""
    scales = range(CENTRES[0], CENTRES[-1] + DELTAS[-1] + 1)
    kernels = np.stack([gabor(angle) for angle in ANGLES], axis=1).reshape(2 * len(ANGLES), -1)
    kernels = torch.from_numpy(kernels).to(stack.device)
    return {s: _energies(stack.grid.extend(stack.intensity[s], s), kernels) * GAIN ** (s - CENTRES[0]) for s in scales}


def _energies(images, kernels):
    even, odd = (kernels @ functional.unfold(_padded(images, RADIUS), 2 * RADIUS + 1)).chunk(2, 1)
    return torch.sqrt(even * even + odd * odd).unflatten(2, images.shape[2:])


def contrast(stack: Stack) -> torch.Tensor:
    """(v, 1, h, w) at scale 4: the luminance variance."""
    side = max(round(WINDOW * stack.view_shape[0]), 3)
    values = torch.where(stack.known, stack.luminance, 0).double()
    sums = _window_sums(torch.cat([stack.known.double(), values, values * values], 1), side)
    count = sums[:, :1].clamp(min=1)
    mean = sums[:, 1:2] / count
    return stack.grid.reduce(((sums[:, 2:] / count - mean * mean) / 255**2).float(), 0)


def _window_sums(planes, side):
    """Sums over side x side windows of planes (v, c, h, w) f8 of integers, so exact; zero outside."""
    for dim in (2, 3):
        length = planes.shape[dim]
        passed = torch.cat([torch.zeros_like(planes.narrow(dim, 0, 1)), planes.cumsum(dim)], dim)
        first = torch.arange(length, device=planes.device) - side // 2
        ends = [passed.index_select(dim, at.clamp(0, length)) for at in (first + side, first)]
        planes = ends[0] - ends[1]
    return planes


def edge(stack: Stack) -> torch.Tensor:
    """(v, 1, h, w) at scale 4: |LoG|."""
    sigma = max(SIGMA * stack.view_shape[0], 0.7)
    half = round(8 * sigma + 1) // 2  # as OpenCV: four sigma on each side
    kernel = [float(weight) for weight in cv2.getGaussianKernel(2 * half + 1, sigma, cv2.CV_32F)[half:, 0]]
    smooth = _padded(stack.grid.extend(stack.luminance, 0), half)
    for dim in (3, 2):
        n = smooth.shape[dim] - 2 * half
        near = [smooth.narrow(dim, start, n) for start in range(2 * half + 1)]
        smooth = near[half] * kernel[0] + sum(kernel[j] * (near[half - j] + near[half + j]) for j in range(1, half + 1))
    padded = _padded(stack.grid.extend(smooth, 0), 1)
    laplacian = padded[..., 1:-1, :-2] + padded[..., 1:-1, 2:] + padded[..., :-2, 1:-1] + padded[..., 2:, 1:-1]
    return stack.grid.reduce((laplacian - 4 * smooth).abs() * (sigma**2 / 255), 0)


def entropy(stack: Stack) -> torch.Tensor:
    """(v, 1, h, w) at scale 4: the entropy in 9 x 9 after a median."""
    smooth = _median(_padded(stack.grid.extend(stack.luminance, 0), MEDIAN // 2))
    levels = functional.pad(torch.where(stack.known, smooth, -1).short(), (SIDE // 2,) * 4, value=-1)
    cover = stack.cover[SCALE]
    windows = levels.unfold(2, SIDE, 2**SCALE).unfold(3, SIDE, 2**SCALE)[cover].flatten(1)
    values = torch.zeros(cover.shape, device=stack.device)
    values[cover] = _entropies(windows)
    return stack.grid.reduce(stack.grid.fill(values, cover, SCALE), SCALE)


def _median(padded):
    """Median of 3 x 3: sort the columns; the median is that of the least top, the middle of middles, the last low."""
    top, middle, low = _sort3(padded[:, :, :-2], padded[:, :, 1:-1], padded[:, :, 2:])
    tops, middles, lows = ([p[..., :-2], p[..., 1:-1], p[..., 2:]] for p in (top, middle, low))
    return _sort3(_sort3(*tops)[2], _sort3(*middles)[1], _sort3(*lows)[0])[1]


def _sort3(a, b, c):
    a, b = torch.minimum(a, b), torch.maximum(a, b)
    b, c = torch.minimum(b, c), torch.maximum(b, c)
    return torch.minimum(a, b), torch.maximum(a, b), c


def _entropies(windows):
    """(k,) f4: entropy in bits of windows (k, n) of levels, negative ones left out, from the runs of sorted levels."""
    levels = windows.sort(1).values
    k, n = levels.shape
    at = torch.arange(n, dtype=torch.int32, device=levels.device)
    changes = levels[:, 1:] != levels[:, :-1]
    ends = functional.pad(changes, (0, 1), value=True) & (levels >= 0)
    starts = torch.where(functional.pad(changes, (1, 0), value=False), at, 0).cummax(1).values
    lengths = torch.where(ends, at - starts + 1, 0)
    summed = torch.from_numpy(PLOGP).to(levels.device)[lengths.long()].sum(1)
    count = (levels >= 0).sum(1).clamp(min=1).double()
    return (count.log2() - summed / count).float().clamp(min=0)


def _padded(images, width):
    return functional.pad(images, (width,) * 4, mode="replicate")
