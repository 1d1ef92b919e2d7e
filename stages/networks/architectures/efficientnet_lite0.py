"""EfficientNet-Lite0: EfficientNet-B0 (Tan & Le 2019) without squeeze and excitation, with ReLU6, for small machines.

Implemented here, since torchvision has none and the package with its weights has had one release, in 2020. Layers,
paddings and normalisation are those of the published TensorFlow model; its stochastic depth, a regulariser for long
trainings, is left out.
"""

import torch

from ..restore import restore
from .architecture import Architecture

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


def efficientnet_lite0(state: dict[str, torch.Tensor] | None) -> Architecture:
    """EfficientNet-Lite0's Architecture: 1280 maps of 7 x 7 at 224 pixels. state: of `full_network`, or None."""
    network = full_network()
    if state is not None:
        restore(network, state, "efficientnet_lite0")
    convolutions, classifier = network.children()
    assert isinstance(convolutions, torch.nn.Sequential) and isinstance(classifier, torch.nn.Linear)
    return Architecture(convolutions, WIDTH, dropout=0.2, classifier=classifier)


def full_network() -> torch.nn.ModuleDict:
    """The convolutions and the ImageNet classifier, in the order of the published weights."""
    layers: list[torch.nn.Module] = [_unit(3, STEM, kernel=3, stride=2)]
    channels = STEM
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
    """Expansion, depthwise convolution and projection, with a shortcut where the shapes allow one."""

    def __init__(self, channels: int, out: int, kernel: int, stride: int, expansion: int) -> None:
        super().__init__()
        wide = channels * expansion
        layers = [_unit(channels, wide)] if expansion > 1 else []
        layers += [_unit(wide, wide, kernel, stride, groups=wide), _unit(wide, out, activate=False)]
        self.layers = torch.nn.Sequential(*layers)
        self.shortcut = stride == 1 and channels == out

    def forward(self, maps: torch.Tensor) -> torch.Tensor:
        return maps + self.layers(maps) if self.shortcut else self.layers(maps)


def _unit(channels, out, kernel=1, stride=1, groups=1, activate=True):
    """Convolution and normalisation.

    Where it halves the maps, the odd row and column of padding lie below and to the right, as in TensorFlow for maps of
    an even size.
    """
    before, after = (kernel - stride) // 2, (kernel - stride + 1) // 2
    layers: list[torch.nn.Module] = []
    if before != after:
        layers.append(torch.nn.ZeroPad2d((before, after, before, after)))
    padding = 0 if before != after else before
    layers.append(torch.nn.Conv2d(channels, out, kernel, stride, padding, groups=groups, bias=False))
    layers.append(torch.nn.BatchNorm2d(out, eps=EPSILON))
    return torch.nn.Sequential(*layers, *([torch.nn.ReLU6(inplace=True)] if activate else []))
