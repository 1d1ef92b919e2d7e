"""The parts of an architecture."""

from typing import NamedTuple

import torch


class Architecture(NamedTuple):
    """The convolutions of a network and its ImageNet classifier.

    convolutions: from images (b, 3, h, w) to the last feature maps (b, width, i, j); dropout: the share dropped before
    the classifier; classifier: the linear layer for ImageNet's 1000 classes on the pooled maps, or None where the
    published network has more than this one layer after its convolutions.
    """

    convolutions: torch.nn.Sequential
    width: int
    dropout: float
    classifier: torch.nn.Linear | None


def he_initialise(module: torch.nn.Module) -> None:
    """Initialises convolutions and linear layers with He's distribution (He et al. 2015) and zero biases.

    For networks without normalisation layers: with torch's own initialisation the signal shrinks at each layer.
    """
    for layer in module.modules():
        if isinstance(layer, torch.nn.Conv2d | torch.nn.Linear):
            torch.nn.init.kaiming_normal_(layer.weight, mode="fan_in", nonlinearity="relu")
            if layer.bias is not None:
                torch.nn.init.zeros_(layer.bias)
