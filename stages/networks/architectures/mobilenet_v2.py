"""MobileNetV2 (Sandler et al. 2018, T [269])."""

import torch

from ..restore import restore
from ..torchvision_import import torchvision
from .architecture import Architecture


def mobilenet_v2(state: dict[str, torch.Tensor] | None) -> Architecture:
    """MobileNetV2's Architecture: 1280 maps of 7 x 7 at 224 pixels. state: torchvision's weights, or None."""
    whole = torchvision.models.mobilenet_v2()
    if state is not None:
        restore(whole, state, "mobilenet_v2")
    return Architecture(whole.features, width=whole.last_channel, dropout=0.2, classifier=whole.classifier[1])
