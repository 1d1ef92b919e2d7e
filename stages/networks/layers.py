"""Matlab's numbers for the layers of MobileNetV2, as in T table 5.6, and the torch modules they correspond to.

Matlab's `mobilenetv2` has 154 layers: 1 is the input, 2 to 150 are the convolutions with their normalisations and
activations, 151 to 154 are pooling, the linear layer, softmax and output. torchvision's network is the same one,
divided into modules: features[0] is Conv1 (2 to 4), features[1] expanded_conv (5 to 9), features[i] block_i-1,
features[18] Conv_1 (148 to 150). The sum at the end of a block (`add`) is a layer in Matlab and not a module here.
"""

import re
from typing import NamedTuple

import torch

LAYERS = 154
BLOCKS = 16  # after expanded_conv
WITHOUT_SUM = (1, 3, 6, 10, 13, 16)  # blocks without a shortcut, since their stride or width changes
EXPANDED = (
    ("expand", "0.0"), ("expand_BN", "0.1"), ("expand_relu", "0.2"),
    ("depthwise", "1.0"), ("depthwise_BN", "1.1"), ("depthwise_relu", "1.2"), ("project", "2"), ("project_BN", "3"),
)  # fmt: skip
FIRST = (  # of expanded_conv, which expands nothing
    ("depthwise", "0.0"), ("depthwise_BN", "0.1"), ("depthwise_relu", "0.2"), ("project", "1"), ("project_BN", "2"),
)  # fmt: skip
PLAIN = (("", "0"), ("_bn", "1"), ("_relu", "2"))  # of Conv1 and Conv_1


class Layer(NamedTuple):
    """One layer: Matlab's number (from 1) and name, and the corresponding module of a Network, or None."""

    number: int
    name: str
    module: str | None


def layers() -> list[Layer]:
    """The 154 layers of MobileNetV2, in Matlab's order."""
    found = [("input_1", None), *_plain("Conv1", 0), *_block("expanded_conv", 1, FIRST)]
    for i in range(1, BLOCKS + 1):
        found += _block(f"block_{i}", i + 1, EXPANDED)
        found += [] if i in WITHOUT_SUM else [(f"block_{i}_add", None)]
    found += [*_plain("Conv_1", BLOCKS + 2), ("global_average_pooling2d_1", "pool"), ("Logits", "head.1")]
    found += [("Logits_softmax", None), ("ClassificationLayer_Logits", None)]
    return [Layer(number, *layer) for number, layer in enumerate(found, start=1)]


def frozen_modules(layer_range: str, network: torch.nn.Module) -> list[str]:
    """Names of the modules with parameters within a range of layers such as `18:139`, both ends included.

    network: a Network of MobileNetV2. Raises ValueError for text that is not a range, a range beyond the 154 layers,
    one that includes the new classifier, or another network.
    """
    first, last = parse_range(layer_range)
    if not is_mobilenet_v2(network):
        raise ValueError(f"mode {layer_range}: ranges of layers need mobilenet_v2, this is another network")
    wanted = [layer.module for layer in layers() if first <= layer.number <= last and layer.module]
    found = [name for name in wanted if _has_parameters(network.get_submodule(name))]
    if "head.1" in found:
        raise ValueError(f"mode {layer_range}: layer 152 is the new classifier, which must be trained")
    return found


def is_range(mode: str) -> bool:
    """Whether a text has the form of a range of layers, FIRST:LAST."""
    return re.fullmatch(r"\d+:\d+", mode) is not None


def parse_range(layer_range: str) -> tuple[int, int]:
    """(first, last) of a range FIRST:LAST; raises ValueError for anything else, or a range beyond the layers."""
    if not is_range(layer_range):
        raise ValueError(f"{layer_range!r} is not a range of layers such as 18:139")
    first, last = map(int, layer_range.split(":"))
    if not 1 <= first <= last <= LAYERS:
        raise ValueError(f"mode {layer_range}: the layers are 1 to {LAYERS}, first before last")
    return first, last


def is_mobilenet_v2(network: torch.nn.Module) -> bool:
    """Whether the modules with parameters are exactly those that the 154 layers name."""
    known = {layer.module for layer in layers() if layer.module}
    own = dict(network.named_modules())
    return known <= set(own) and all(name in known for name, module in own.items() if _has_parameters(module))


def _has_parameters(module):
    return any(True for _ in module.parameters(recurse=False))


def _plain(name, feature):
    # Matlab names these two layers in another way.
    odd = {"Conv1_bn": "bn_Conv1", "Conv_1_relu": "out_relu"}
    return [(odd.get(name + part, name + part), f"convolutions.{feature}.{module}") for part, module in PLAIN]


def _block(name, feature, parts):
    return [(f"{name}_{part}", f"convolutions.{feature}.conv.{module}") for part, module in parts]
