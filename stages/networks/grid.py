"""Where the cells of a network's last maps lie in the image."""

import numpy as np

GRIDS = {  # network -> (stride, first): cell i looks around pixel first + stride * i, in rows and columns alike
    "alexnet": (16, 15.0),  # kernels of 11 and 3 without as much padding move the first cell inwards
    "googlenet": (32, 22.0),  # pools without padding do
    "vgg16": (16, 7.5),  # pools of 2 do: as if corners of pixels were aligned
    "resnet50": (32, 0.0),  # odd kernels, padded on both sides: cells lie on pixels 0, 32, 64, ...
    "resnet101": (32, 0.0),
    "mobilenet_v2": (32, 0.0),
    "efficientnet_lite0": (32, 31.0),  # padded at the far side alone where it halves an even size
}


def cell_positions(network, size, cells):
    """(size,) f8: for each row (or column) of a picture of `size`, the row of the last maps, of `cells`, it lies at.

    A layer with kernel k, padding p and stride s behind a stride of j moves the first cell by j * ((k - 1) / 2 - p)
    pixels. Pixels beyond the outer cells belong to those. Raises ValueError for an unknown network.
    """
    if network not in GRIDS:
        raise ValueError(f"no grid known of {network!r}, known: {', '.join(GRIDS)}")
    stride, first = GRIDS[network]
    return np.clip((np.arange(size) - first) / stride, 0, cells - 1)
