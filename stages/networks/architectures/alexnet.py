"""AlexNet's convolutions (Krizhevsky et al. 2012, T [268], in torchvision's form of 2014)."""

import torch

from ..restore import restore
from ..vision import torchvision
from .parts import Parts, he_start


def alexnet(state):
    """Parts; state: {`features.N.weight` or `.bias`: tensor}, where `classifier.*` may be too, or None.

    Up to the rectified fifth convolution, without the last max pooling: 13 x 13 maps of 256 at 224 pixels. The thesis
    keeps the fully connected layers fc6 and fc7 and replaces fc8; here, since no registry has their weights, the maps
    are pooled by their mean for one new layer. That is 2.5 of 61 million parameters, and an input of any size.
    """
    with torch.device("meta"):  # else the whole would first draw its 59 million others
        convolutions = torchvision.models.alexnet().features[:-1]
    convolutions.to_empty(device="cpu")
    if state is None:
        he_start(convolutions)
    else:
        restore(convolutions, features_of(state), "alexnet's convolutions")
    return Parts(convolutions, width=256, dropout=0.5, classifier=None)


def features_of(state):
    """The entries of the convolutions among the weights of a torchvision network, without their prefix."""
    return {key.removeprefix("features."): value for key, value in state.items() if not key.startswith("classifier.")}
