"""The scores of a hybrid network, computed in batches, and its rows."""

from collections.abc import Callable
from typing import Any

import numpy as np
import torch

from haptic_glance.deep.device import device_of, explain_out_of_memory
from haptic_glance.deep.hybrid import SENSES, HybridNet, Scores, join_senses

BATCH = 64  # images


def single_sense(images: torch.Tensor, kind: int) -> torch.Tensor:
    """(k, 6, h, w): the images (k, 3, h, w) of one sense, with the other absent. kind: the sense, 0 or 1."""
    return join_senses(images, None) if kind == 0 else join_senses(None, images)


def sense_scores(hybrid: HybridNet, images: torch.Tensor, kind: int) -> np.ndarray:
    """(n, classes) f4 numpy: the scores of one sense's head for its images (n, 3, h, w), without the other sense."""
    return in_batches(lambda part: hybrid(single_sense(part, kind))[kind], images, device_of(hybrid))


@torch.no_grad()
def in_batches(function: Callable[[torch.Tensor], Any], images: torch.Tensor, device: torch.device) -> Any:
    """function(images), computed in batches on the device: an array for a tensor, a tuple of arrays for Scores."""
    with explain_out_of_memory():
        found = [function(part.to(device)) for part in images.split(BATCH)]
    if isinstance(found[0], Scores):
        return tuple(torch.cat(part).cpu().numpy() for part in zip(*found, strict=True))
    return torch.cat(found).cpu().numpy()


def row(method: str, metric: str, value: float, kind: int | None = None, seconds: float | None = None) -> dict:
    """A row of a measurement. kind: the sense, 0 or 1, or None for the whole network."""
    sense = None if kind is None else SENSES[kind]
    return {"method": method, "sense": sense, "metric": metric, "value": value, "seconds": seconds}
