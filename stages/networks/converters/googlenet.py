"""GoogLeNet as torchvision publishes it: trained with other colours and with two auxiliary classifiers."""

from .fold import fold_input

SCALE, SHIFT = 2.0, -1.0  # the published weights take values in -1..1
EPSILON = 1e-3  # of torchvision's GoogLeNet's normalisation layers


def converted(stored):
    """Weights by torchvision's names for inputs as ours are, from the stored ones."""
    state = {key: value for key, value in stored.items() if not key.startswith("aux")}
    return fold_input(state, "conv1.conv", "conv1.bn", EPSILON, SCALE, SHIFT)
