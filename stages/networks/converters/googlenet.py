"""GoogLeNet as torchvision publishes it: trained on inputs in -1..1 and with two auxiliary classifiers."""

import torch

from .fold import fold_input

SCALE, SHIFT = 2.0, -1.0  # the published weights take values in -1..1
EPSILON = 1e-3  # of torchvision's GoogLeNet's normalisation layers


def convert(stored: dict[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """Weights by torchvision's names for images normalised as in stages.networks, from the stored ones."""
    state = {key: value for key, value in stored.items() if not key.startswith("aux")}
    return fold_input(state, "conv1.conv", "conv1.bn", EPSILON, SCALE, SHIFT)
