"""GoogLeNet (Szegedy et al. 2015, T [60])."""

from collections import OrderedDict

import torch

from ..restore import restore
from ..vision import torchvision
from .parts import Parts


def googlenet(state):
    """Parts; state: torchvision's names without the auxiliary classifiers, or None. 7 x 7 maps of 1024 at 224 px."""
    whole = torchvision.models.googlenet(aux_logits=False, transform_input=False, init_weights=True)
    if state is not None:
        restore(whole, state, "googlenet")
    layers = OrderedDict((name, layer) for name, layer in whole.named_children() if name not in TAIL)
    return Parts(torch.nn.Sequential(layers), width=1024, dropout=0.2, classifier=whole.fc)


TAIL = ("aux1", "aux2", "avgpool", "dropout", "fc")
