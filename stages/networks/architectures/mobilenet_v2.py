"""MobileNetV2 (Sandler et al. 2018, T [269])."""

from ..restore import restore
from ..vision import torchvision
from .parts import Parts


def mobilenet_v2(state):
    """Parts of torchvision's MobileNetV2; state: its names, or None. 7 x 7 maps of 1280 at 224 pixels."""
    whole = torchvision.models.mobilenet_v2()
    if state is not None:
        restore(whole, state, "mobilenet_v2")
    return Parts(whole.features, width=whole.last_channel, dropout=0.2, classifier=whole.classifier[1])
