"""Gaussian pyramids of many images at once, each with a size of its own within one tensor.

The object's crop differs from view to view, and the filters meet the crop's own border. So every image keeps its size
and lies in the upper left of its plane; `extend` repeats its last row and column over what is left of the plane, and
then one filter over the whole tensor, with replicated borders, gives each image what it would give it alone.

Sums of shifted slices stand in place of convolutions: cuDNN rounds these to ten bits (TF32) unless told otherwise.
"""

import numpy as np
import torch
from torch.nn import functional

from ..background import ENOUGH
from ..operators import COMMON


class Grid:
    """Where v images of sizes (v, 2), rows and columns at scale 0, lie in their tensor at every scale."""

    def __init__(self, sizes, device):
        self.sizes, self.device = np.asarray(sizes), torch.device(device)

    def sizes_at(self, scale):
        """(v, 2) rows and columns of every image at a scale."""
        return -(-self.sizes // 2**scale)

    def shape(self, scale):
        """(h, w) of the tensor at a scale."""
        return tuple(int(side) for side in self.sizes_at(scale).max(axis=0))

    def within(self, scale):
        """(v, 1, h, w) boolean: inside the image."""
        (rows, columns), (h, w) = self.sizes_at(scale).T, self.shape(scale)
        inside = (np.arange(h)[:, None] < rows[:, None, None]) & (np.arange(w) < columns[:, None, None])
        return torch.from_numpy(inside[:, None]).to(self.device)

    def extend(self, images, scale):
        """Images (v, c, h, w) with their last row and column repeated over the rest of the plane."""
        sizes, shape = self.sizes_at(scale), self.shape(scale)
        for dim, own, side in ((2, sizes[:, 0], shape[0]), (3, sizes[:, 1], shape[1])):
            if (own < side).any():
                at = torch.from_numpy(np.minimum(np.arange(side), own[:, None] - 1)).to(self.device)
                images = images.gather(dim, at[:, None, :, None].transpose(2, dim).expand_as(images))
        return images

    def down(self, images, scale):
        """cv2.pyrDown with replicated borders: images (v, c, h, w) of a scale at the next one."""
        images = functional.pad(self.extend(images, scale), (2, 2, 2, 2), mode="replicate")
        for dim in (3, 2):
            a, b, c, d, e = (_every_second(images, dim, start) for start in range(5))
            images = c * 6 + ((b + d) * 4 + (a + e))
        return images * (1 / 256)

    def up(self, images, scale):
        """cv2.pyrUp: images (v, c, h, w) of a scale at the next finer one.

        Reflected before the first pixel, the last one repeated after the last, as OpenCV has it.
        """
        images = self.extend(images, scale)
        for dim, side in zip((3, 2), self.shape(scale - 1)[::-1], strict=True):
            n = images.shape[dim]
            before = torch.cat([images.narrow(dim, min(1, n - 1), 1), images.narrow(dim, 0, n - 1)], dim)
            after = torch.cat([images.narrow(dim, 1, n - 1), images.narrow(dim, n - 1, 1)], dim)
            pair = torch.stack([before + after + images * 6, (images + after) * 4], dim + 1)
            images = pair.flatten(dim, dim + 1).narrow(dim, 0, side)
        return images * (1 / 64)

    def reduce(self, images, scale, target=COMMON):
        """Images, given at a scale, at the coarser scale `target`."""
        for finer in range(scale, target):
            images = self.down(images, finer)
        return images

    def expand(self, images, scale, target):
        """Images, given at a scale, at the finer scale `target`."""
        for coarser in range(scale, target, -1):
            images = self.up(images, coarser)
        return images

    def pyramid(self, images, first, last):
        """{first: images, ..., last: ...} of images (v, c, h, w) given at scale `first`."""
        levels = {first: images}
        for scale in range(first, last):
            levels[scale + 1] = self.down(levels[scale], scale)
        return levels

    def fill(self, images, known, scale=0):
        """Pull-push as in stages.conspicuity.background.fill: images (v, c, h, w) f4, known (v, 1, h, w) boolean."""
        if max(self.shape(scale)) == 1:
            return torch.where(known, images, 0)
        weight = known.float()
        pulled, share = self.down(images * weight, scale), self.down(weight, scale)
        coarse = self.fill(pulled / share.clamp(min=ENOUGH), share > ENOUGH, scale + 1)
        return torch.where(known, images, self.up(coarse, scale + 1))


def _every_second(images, dim, start):
    """Every second pixel from `start`, as many as the image, padded by two on either side, leaves at the next scale."""
    count = (images.shape[dim] - 4 + 1) // 2
    index = [slice(None)] * 4
    index[dim] = slice(start, start + 2 * count - 1, 2)
    return images[tuple(index)]
