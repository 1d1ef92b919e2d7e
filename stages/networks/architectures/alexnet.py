"""AlexNet's convolutions (Krizhevsky et al. 2012, T [268], in torchvision's form of 2014)."""

import torch

from ..restore import restore
from ..torchvision_import import torchvision
from .architecture import Architecture, he_initialise


def alexnet(state: dict[str, torch.Tensor] | None) -> Architecture:
    """AlexNet's Architecture. state: {`features.N.weight` or `.bias`: tensor}, with or without `classifier.*`, or None.

    The convolutions end at the rectified fifth one, without the last max pooling: 256 maps of 13 x 13 at 224 pixels.
    The thesis keeps the fully connected layers fc6 and fc7 and replaces fc8. No package registry has their weights, so
    here the maps are averaged and classified by one new layer, which has 2.5 of 61 million parameters and takes any
    size.
    """
    with torch.device("meta"):  # so that the 59 million other parameters are not initialised
        convolutions = torchvision.models.alexnet().features[:-1]
    convolutions.to_empty(device="cpu")
    if state is None:
        he_initialise(convolutions)
    else:
        restore(convolutions, features_of(state), "alexnet's convolutions")
    return Architecture(convolutions, width=256, dropout=0.5, classifier=None)


def features_of(state: dict[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """The weights of the convolutions among those of a torchvision network, without their prefix."""
    return {key.removeprefix("features."): value for key, value in state.items() if not key.startswith("classifier.")}
