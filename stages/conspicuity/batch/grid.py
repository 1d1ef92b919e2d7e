"""Gaussian pyramids of a batch of images of different sizes within one tensor.

The crops of the object differ in size between views, and filters depend on the border of the crop. So each image
keeps its size and lies in the upper left of its plane. `extend` repeats its last row and column over the rest of the
plane. One filter over the whole tensor, with replicated borders, then gives the same result as on each image alone.

Convolutions are written as sums of shifted slices, since cuDNN rounds convolutions to ten bits (TF32) by default.
"""

from collections.abc import Sequence

import numpy as np
import torch
from torch.nn import functional

from ..background import MIN_WEIGHT
from ..operators import OUTPUT_SCALE


class Grid:
    """The sizes (v, 2) of v images, rows and columns at scale 0, and operations on their tensors at every scale."""

    def __init__(self, sizes: Sequence[tuple[int, int]], device: str | torch.device) -> None:
        self.sizes, self.device = np.asarray(sizes), torch.device(device)

    def sizes_at(self, scale: int) -> np.ndarray:
        """(v, 2) rows and columns of every image at a scale."""
        return -(-self.sizes // 2**scale)

    def shape(self, scale: int) -> tuple[int, int]:
        """(h, w) of the tensor at a scale."""
        h, w = self.sizes_at(scale).max(axis=0)
        return int(h), int(w)

    def within(self, scale: int) -> torch.Tensor:
        """(v, 1, h, w) boolean: the pixel belongs to the image."""
        (rows, columns), (h, w) = self.sizes_at(scale).T, self.shape(scale)
        inside = (np.arange(h)[:, None] < rows[:, None, None]) & (np.arange(w) < columns[:, None, None])
        return torch.from_numpy(inside[:, None]).to(self.device)

    def extend(self, images: torch.Tensor, scale: int) -> torch.Tensor:
        """Images (v, c, h, w) with their last row and column repeated over the rest of the plane."""
        sizes, shape = self.sizes_at(scale), self.shape(scale)
        for dim, own, side in ((2, sizes[:, 0], shape[0]), (3, sizes[:, 1], shape[1])):
            if (own < side).any():
                at = torch.from_numpy(np.minimum(np.arange(side), own[:, None] - 1)).to(self.device)
                images = images.gather(dim, at[:, None, :, None].transpose(2, dim).expand_as(images))
        return images

    def down(self, images: torch.Tensor, scale: int) -> torch.Tensor:
        """cv2.pyrDown with replicated borders: images (v, c, h, w) of a scale at the next one."""
        images = functional.pad(self.extend(images, scale), (2, 2, 2, 2), mode="replicate")
        for dim in (3, 2):
            a, b, c, d, e = (_every_second(images, dim, start) for start in range(5))
            images = c * 6 + ((b + d) * 4 + (a + e))
        return images * (1 / 256)

    def up(self, images: torch.Tensor, scale: int) -> torch.Tensor:
        """cv2.pyrUp: images (v, c, h, w) of a scale at the next finer one.

        Reflected before the first pixel, and the last one repeated, as in OpenCV.
        """
        images = self.extend(images, scale)
        for dim, side in zip((3, 2), self.shape(scale - 1)[::-1], strict=True):
            n = images.shape[dim]
            before = torch.cat([images.narrow(dim, min(1, n - 1), 1), images.narrow(dim, 0, n - 1)], dim)
            after = torch.cat([images.narrow(dim, 1, n - 1), images.narrow(dim, n - 1, 1)], dim)
            pair = torch.stack([before + after + images * 6, (images + after) * 4], dim + 1)
            images = pair.flatten(dim, dim + 1).narrow(dim, 0, side)
        return images * (1 / 64)

    def reduce(self, images: torch.Tensor, scale: int, target: int = OUTPUT_SCALE) -> torch.Tensor:
        """Images, given at a scale, at the coarser scale `target`."""
        for finer in range(scale, target):
            images = self.down(images, finer)
        return images

    def expand(self, images: torch.Tensor, scale: int, target: int) -> torch.Tensor:
        """Images, given at a scale, at the finer scale `target`."""
        for coarser in range(scale, target, -1):
            images = self.up(images, coarser)
        return images

    def pyramid(self, images: torch.Tensor, first: int, last: int) -> dict[int, torch.Tensor]:
        """{first: images, ..., last: ...} of images (v, c, h, w) given at scale `first`."""
        levels = {first: images}
        for scale in range(first, last):
            levels[scale + 1] = self.down(levels[scale], scale)
        return levels

    def fill(self, images: torch.Tensor, known: torch.Tensor, scale: int = 0) -> torch.Tensor:
        """Pull-push as in stages.conspicuity.background.fill: images (v, c, h, w) f4, known (v, 1, h, w) boolean."""
        if max(self.shape(scale)) == 1:
            return torch.where(known, images, 0)
        weight = known.float()
        pulled, share = self.down(images * weight, scale), self.down(weight, scale)
        coarse = self.fill(pulled / share.clamp(min=MIN_WEIGHT), share > MIN_WEIGHT, scale + 1)
        return torch.where(known, images, self.up(coarse, scale + 1))


def _every_second(images, dim, start):
    """Every second pixel from `start` of images padded by two: as many as the next scale has."""
    count = (images.shape[dim] - 4 + 1) // 2
    index = [slice(None)] * 4
    index[dim] = slice(start, start + 2 * count - 1, 2)
    return images[tuple(index)]
