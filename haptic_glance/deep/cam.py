"""Grad-CAM (T3.3), and its maps at the size of pictures.

Grad-CAM from the last maps of a network (T eq. 3.18, 3.19).

The positions in the image of the cells of a network's last feature maps, and maps resized to the image.
"""

from collections.abc import Callable

import numpy as np
import torch


def grad_cam(
    maps: np.ndarray | torch.Tensor,
    scores: Callable[[torch.Tensor], torch.Tensor],
    classes: np.ndarray | torch.Tensor | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """((b, i, j) f4 Grad-CAM maps of b images, not negative, (b,) i8 their classes) (Selvaraju et al. 2017, T [65]).

    maps (b, C, i, j): of the last convolution, which may come from a cache; scores: what follows it in the network,
    from maps to scores (b, k) before the softmax; classes (b,): those to explain, None for the predicted ones. The
    weight of a map is the derivative of the score by its cells, averaged over them (T eq. 3.19). It is the same in each
    cell where the maps are averaged and classified by one layer, but not before fully connected layers. Raises
    ValueError for shapes that do not fit.
    """
    maps = torch.as_tensor(maps).detach().float()
    if maps.ndim != 4:
        raise ValueError(f"maps must have shape (b, C, i, j), got {tuple(maps.shape)}")
    with torch.enable_grad():
        leaf = maps.clone().requires_grad_(True)
        found = scores(leaf)
        chosen = found.argmax(dim=1) if classes is None else torch.as_tensor(classes, device=found.device)
        if chosen.shape != maps.shape[:1]:
            raise ValueError(f"maps {tuple(maps.shape)} and classes {tuple(chosen.shape)} do not fit")
        [gradient] = torch.autograd.grad(found.gather(1, chosen[:, None]).sum(), leaf)
    importance = gradient.double().mean(dim=(2, 3)).float()  # double: the mean of equal numbers is that number
    b, channels, i, j = maps.shape
    summed = importance.cpu().numpy()[:, None] @ maps.cpu().numpy().reshape(b, channels, i * j)
    return np.maximum(summed, 0).reshape(b, i, j), chosen.cpu().numpy()


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
