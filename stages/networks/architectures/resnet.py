"""ResNet50 and ResNet101 (He et al. 2016, T [59])."""

from collections import OrderedDict

import torch

from ..restore import restore
from ..vision import torchvision
from .parts import Parts


def resnet50(state):
    """Parts of torchvision's ResNet50; state: its names, or None. 7 x 7 maps of 2048 at 224 pixels."""
    return _parts(torchvision.models.resnet50(), state, "resnet50")


def resnet50_early(state):
    """Parts of the ResNet50 of the paper, and of Keras and Matlab: each stage halves the maps in its first 1 x 1
    convolution; torchvision moved that to the 3 x 3 one. state: torchvision's names, or None.
    """
    whole = torchvision.models.resnet50()
    for stage in (whole.layer2, whole.layer3, whole.layer4):
        stage[0].conv1.stride, stage[0].conv2.stride = (2, 2), (1, 1)
    return _parts(whole, state, "resnet50")


def resnet101(state):
    """Parts of torchvision's ResNet101; state: its names, or None. 7 x 7 maps of 2048 at 224 pixels."""
    return _parts(torchvision.models.resnet101(), state, "resnet101")


def _parts(whole, state, name):
    if state is not None:
        restore(whole, state, name)
    layers = OrderedDict((name, layer) for name, layer in whole.named_children() if name not in ("avgpool", "fc"))
    return Parts(torch.nn.Sequential(layers), width=whole.fc.in_features, dropout=0.0, classifier=whole.fc)
