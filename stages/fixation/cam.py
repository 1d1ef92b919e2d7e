"""Grad-CAM of a network whose head is linear on the pooled last maps (T eq. 3.18, 3.19)."""

import numpy as np

from stages.networks.grid import cell_positions


def grad_cam(maps, weights, classes):
    """(b, i, j) f4, not negative: where b images hold what speaks for their class (Selvaraju et al. 2017, T [65]).

    maps (b, C, i, j): the last convolution's; weights (k, C): the head's, score = mean over the map @ weights.T +
    bias; classes (b,) i8: the class whose score is asked about, usually the winning one. The score's derivative by
    each of the Z pixels of map k is weights[class, k] / Z, so that its mean over the map (T eq. 3.19) is just that: no
    backward pass is needed, and maps may come from a cache. Raises ValueError for shapes that do not fit.
    """
    maps, weights = np.asarray(maps, dtype=np.float32), np.asarray(weights, dtype=np.float32)
    classes = np.asarray(classes, dtype=np.int64)
    if maps.ndim != 4 or weights.ndim != 2 or maps.shape[1] != weights.shape[1] or classes.shape != maps.shape[:1]:
        shapes = f"{maps.shape}, {weights.shape} and {classes.shape}"
        raise ValueError(f"maps (b, C, i, j), weights (k, C) and classes (b,) do not fit: {shapes}")
    b, channels, i, j = maps.shape
    importance = weights[classes] / (i * j)
    return np.maximum(importance[:, None] @ maps.reshape(b, channels, i * j), 0).reshape(b, i, j)


def to_size(cams, size, network):
    """Maps (b, i, j) as pictures (b, size, size) f4, bilinear, each over its own maximum; zero maps stay zero.

    network: whose maps they are; it says around which pixels its cells look (stages.networks.grid). To align the
    corners of pixels, as resizing does, would move the maps of most networks by half a cell.
    """
    cams = np.asarray(cams, dtype=np.float32)
    down, across = (_weights(cell_positions(network, size, cells), cells) for cells in cams.shape[1:])
    large = down @ cams @ across.T
    top = large.max(axis=(1, 2), keepdims=True)
    return np.divide(large, top, out=np.zeros_like(large), where=top > 0)


def _weights(places, cells):
    """(p, cells) f4: how much each cell counts at a place between two of them."""
    return np.maximum(1 - np.abs(places[:, None] - np.arange(cells)), 0).astype(np.float32)
