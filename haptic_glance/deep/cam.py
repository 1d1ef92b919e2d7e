"""Grad-CAM from the last maps of a network (T3.3, T eq. 3.18, 3.19)."""

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
        logits = scores(leaf)
        targets = logits.argmax(dim=1) if classes is None else torch.as_tensor(classes, device=logits.device)
        if targets.shape != maps.shape[:1]:
            raise ValueError(f"maps {tuple(maps.shape)} and classes {tuple(targets.shape)} do not fit")
        [gradient] = torch.autograd.grad(logits.gather(1, targets[:, None]).sum(), leaf)
    importance = gradient.double().mean(dim=(2, 3)).float()  # double: the mean of equal numbers is that number
    b, channels, i, j = maps.shape
    summed = importance.cpu().numpy()[:, None] @ maps.cpu().numpy().reshape(b, channels, i * j)
    return np.maximum(summed, 0).reshape(b, i, j), targets.cpu().numpy()
