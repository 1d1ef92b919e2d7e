"""VGG16's convolutions (Simonyan & Zisserman 2015, T [235])."""

import torch

from ..restore import restore
from ..torchvision_import import torchvision
from .alexnet import features_of
from .architecture import Architecture, he_initialise


def vgg16(state: dict[str, torch.Tensor] | None) -> Architecture:
    """VGG16's Architecture. state: {`features.N.weight` or `.bias`: tensor}, with or without `classifier.*`, or None.

    The convolutions end at the rectified thirteenth one, without the last max pooling: 512 maps of 14 x 14 at 224
    pixels, which Grad-CAM uses. The thesis keeps the fully connected layers fc6 and fc7 and replaces fc8. No package
    registry has their weights, so here the maps are averaged and classified by one new layer: 14.7 of 138 million
    parameters.
    """
    vgg = torchvision.models.vgg
    convolutions = vgg.make_layers(vgg.cfgs["D"])[:-1]  # so that the 124 million other parameters are not initialised
    if state is None:
        he_initialise(convolutions)
    else:
        restore(convolutions, features_of(state), "vgg16's convolutions")
    return Architecture(convolutions, width=512, dropout=0.5, classifier=None)
