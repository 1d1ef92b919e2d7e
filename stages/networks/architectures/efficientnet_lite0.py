"""EfficientNet-Lite0: EfficientNet-B0 (Tan & Le 2019) without squeeze and excitation, with ReLU6, for small machines.

Own, since torchvision has none and the package that carries the weights has had one release, in 2020. Layers, paddings
and normalisation are those of the published TensorFlow model; its stochastic depth, a regulariser of long trainings,
is left out.
"""

import torch

from ..restore import restore
from .parts import Parts

STAGES = (  # repeats, kernel, stride, expansion, channels
    (1, 3, 1, 1, 16),
    (2, 3, 2, 6, 24),
    (2, 5, 2, 6, 40),
    (3, 3, 2, 6, 80),
    (3, 5, 1, 6, 112),
    (4, 5, 2, 6, 192),
    (1, 3, 1, 6, 320),
)
STEM, WIDTH = 32, 1280
EPSILON = 1e-3  # of the normalisation layers


def efficientnet_lite0(state):
    """Parts; state: the names of `whole`, or None. 7 x 7 maps of 1280 at 224 pixels."""
    network = whole()
    if state is not None:
        restore(network, state, "efficientnet_lite0")
    return Parts(network.convolutions, WIDTH, dropout=0.2, classifier=network.classifier)


def whole():
    """The convolutions and the classifier of ImageNet's 1000 classes, in the order of the published weights."""
    layers, channels = [_unit(3, STEM, kernel=3, stride=2)], STEM
    for repeats, kernel, stride, expansion, out in STAGES:
        for repeat in range(repeats):
            layers.append(InvertedBottleneck(channels, out, kernel, 1 if repeat else stride, expansion))
            channels = out
    layers.append(_unit(channels, WIDTH))
    for layer in torch.nn.Sequential(*layers).modules():
        if isinstance(layer, torch.nn.Conv2d):
            torch.nn.init.kaiming_normal_(layer.weight, mode="fan_out")
    return torch.nn.ModuleDict(
        {"convolutions": torch.nn.Sequential(*layers), "classifier": torch.nn.Linear(WIDTH, 1000)}
    )


class InvertedBottleneck(torch.nn.Module):
    """Widens, filters each channel by itself, narrows again; beside it a short cut where the shapes allow one."""

    def __init__(self, channels, out, kernel, stride, expansion):
        super().__init__()
        wide = channels * expansion
        layers = [_unit(channels, wide)] if expansion > 1 else []
        layers += [_unit(wide, wide, kernel, stride, groups=wide), _unit(wide, out, activate=False)]
        self.layers = torch.nn.Sequential(*layers)
        self.short_cut = stride == 1 and channels == out

    def forward(self, maps):
        return maps + self.layers(maps) if self.short_cut else self.layers(maps)


def _unit(channels, out, kernel=1, stride=1, groups=1, activate=True):
    """Convolution and normalisation. Where it halves the maps, the odd row and column of padding lie below and right,
    as TensorFlow puts them for maps of an even size.
    """
    before, after = (kernel - stride) // 2, (kernel - stride + 1) // 2
    layers = [torch.nn.ZeroPad2d((before, after, before, after))] if before != after else []
    padding = 0 if before != after else before
    layers.append(torch.nn.Conv2d(channels, out, kernel, stride, padding, groups=groups, bias=False))
    layers.append(torch.nn.BatchNorm2d(out, eps=EPSILON))
    return torch.nn.Sequential(*layers, *([torch.nn.ReLU6(inplace=True)] if activate else []))
