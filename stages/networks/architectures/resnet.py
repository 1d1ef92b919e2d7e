"""ResNet50 and ResNet101 (He et al. 2016, T [59])."""

from collections import OrderedDict

import torch

from ..restore import restore
from ..torchvision_import import torchvision
from .architecture import Architecture


def resnet50(state: dict[str, torch.Tensor] | None) -> Architecture:
    """ResNet50's Architecture: 2048 maps of 7 x 7 at 224 pixels. state: torchvision's weights, or None."""
    return _parts(torchvision.models.resnet50(), state, "resnet50")


def resnet50_v1(state: dict[str, torch.Tensor] | None) -> Architecture:
    """The Architecture of the original ResNet50 (v1), as in the paper, Keras and Matlab.

    Each stage halves the maps in its first 1 x 1 convolution; torchvision (v1.5) does so in the 3 x 3 one. state:
    weights by torchvision's names, or None.
    """
    whole = torchvision.models.resnet50()
    for stage in (whole.layer2, whole.layer3, whole.layer4):
        stage[0].conv1.stride, stage[0].conv2.stride = (2, 2), (1, 1)
    return _parts(whole, state, "resnet50")


def resnet101(state: dict[str, torch.Tensor] | None) -> Architecture:
    """ResNet101's Architecture: 2048 maps of 7 x 7 at 224 pixels. state: torchvision's weights, or None."""
    return _parts(torchvision.models.resnet101(), state, "resnet101")


def _parts(whole, state, name):
    if state is not None:
        restore(whole, state, name)
    layers = OrderedDict((name, layer) for name, layer in whole.named_children() if name not in ("avgpool", "fc"))
    return Architecture(torch.nn.Sequential(layers), width=whole.fc.in_features, dropout=0.0, classifier=whole.fc)
