"""What an architecture is made of here."""

from typing import NamedTuple

import torch


class Parts(NamedTuple):
    """convolutions: images (b, 3, h, w) to the last maps (b, width, i, j); dropout: the share that the architecture
    drops before its classifier; classifier: the linear layer of ImageNet's 1000 classes on the pooled maps, or None
    where the architecture has more than that one layer behind its convolutions.
    """

    convolutions: torch.nn.Module
    width: int
    dropout: float
    classifier: torch.nn.Linear | None


def he_start(module):
    """Draws the convolutions from He's distribution (He et al. 2015) and clears their biases.

    For networks without normalisation layers: torch's own start shrinks the signal at each layer.
    """
    for layer in module.modules():
        if isinstance(layer, torch.nn.Conv2d):
            torch.nn.init.kaiming_normal_(layer.weight, mode="fan_in", nonlinearity="relu")
            torch.nn.init.zeros_(layer.bias)
