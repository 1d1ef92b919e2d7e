"""Grad-CAM maps at the size of pictures: the positions in the image of the cells of a network's last feature maps.

Needs no network: the report draws kept maps without the extra `deep`.
"""

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


def resize_cams(cams: np.ndarray, size: int, network: str) -> np.ndarray:
    """(b, size, size) f4: maps (b, i, j) resized bilinearly, each divided by its maximum; zero maps stay zero.

    network: decides the positions of the cells in the image (`cell_positions`). Ordinary resizing, which aligns the
    corners of pixels, would shift the maps of most networks by half a cell.
    """
    cams = np.asarray(cams, dtype=np.float32)
    down, across = (_weights(cell_positions(network, size, cells), cells) for cells in cams.shape[1:])
    large = down @ cams @ across.T
    top = large.max(axis=(1, 2), keepdims=True)
    return np.divide(large, top, out=np.zeros_like(large), where=top > 0)


def _weights(positions, cells):
    """(p, cells) f4: the weight of each cell at a position between two of them."""
    return np.maximum(1 - np.abs(positions[:, None] - np.arange(cells)), 0).astype(np.float32)
