"""Grad-CAM of a network whose head is linear on the pooled last maps (T eq. 3.18, 3.19)."""

import numpy as np

from stages.networks.grid import cell_positions


def grad_cam(maps: np.ndarray, weights: np.ndarray, classes: np.ndarray) -> np.ndarray:
    """(b, i, j) f4: Grad-CAM maps of b images, not negative (Selvaraju et al. 2017, T [65]).

    maps (b, C, i, j): of the last convolution; weights (k, C): of the head, whose scores are the mean over each map @
    weights.T + bias; classes (b,) i8: the class to explain, usually the predicted one. The derivative of the score by
    each of the Z pixels of map k is weights[class, k] / Z, which is also its mean over the map (T eq. 3.19). So no
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


def resize_cams(cams: np.ndarray, size: int, network: str) -> np.ndarray:
    """(b, size, size) f4: maps (b, i, j) resized bilinearly, each divided by its maximum; zero maps stay zero.

    network: decides the positions of the cells in the image (stages.networks.grid). Ordinary resizing, which aligns the
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
