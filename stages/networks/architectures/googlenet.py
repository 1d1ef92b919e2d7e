"""GoogLeNet (Szegedy et al. 2015, T [60])."""

from collections import OrderedDict

import torch

from ..restore import restore
from ..torchvision_import import torchvision
from .architecture import Architecture


def googlenet(state: dict[str, torch.Tensor] | None) -> Architecture:
    """GoogLeNet's Architecture: 1024 maps of 7 x 7 at 224 pixels.

    state: torchvision's weights without the auxiliary classifiers, or None.
    """
    whole = torchvision.models.googlenet(aux_logits=False, transform_input=False, init_weights=True)
    if state is not None:
        restore(whole, state, "googlenet")
    layers = OrderedDict((name, layer) for name, layer in whole.named_children() if name not in TAIL)
    return Architecture(torch.nn.Sequential(layers), width=1024, dropout=0.2, classifier=whole.fc)


TAIL = ("aux1", "aux2", "avgpool", "dropout", "fc")
