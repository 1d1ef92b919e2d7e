"""The positions in the image of the cells of a network's last feature maps."""

import numpy as np

# network -> (stride, first): the receptive field of cell i is centred on pixel first + stride * i, in rows and columns
GRIDS = {
    "alexnet": (16, 15.0),  # kernels of 11 and 3 with little padding move the first cell inwards
    "googlenet": (32, 22.0),  # so do pools without padding
    "vgg16": (16, 7.5),  # so do pools of 2
    "resnet50": (32, 0.0),  # odd kernels, padded on both sides: cells are centred on pixels 0, 32, 64, ...
    "resnet101": (32, 0.0),
    "mobilenet_v2": (32, 0.0),
    "efficientnet_lite0": (32, 31.0),  # padded on the far side alone where an even size is halved
}


def cell_positions(network: str, size: int, cells: int) -> np.ndarray:
    """(size,) f8: the position of each row (or column) of an image on the rows of the last feature maps.

    size: rows of the image; cells: rows of the maps. A layer with kernel k and padding p after a total stride of j
    moves the first cell by j * ((k - 1) / 2 - p) pixels. Pixels outside the outer cells get the positions of those.
    Raises ValueError for an unknown network.
    """
    if network not in GRIDS:
        raise ValueError(f"unknown network {network!r}, known: {', '.join(GRIDS)}")
    stride, first = GRIDS[network]
    return np.clip((np.arange(size) - first) / stride, 0, cells - 1)
