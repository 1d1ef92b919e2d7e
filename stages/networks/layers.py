"""Matlab's numbers for the layers of MobileNetV2, as T table 5.6 uses them, and the modules that they are here.

Matlab's `mobilenetv2` has 154 layers: 1 is the input, 2 to 150 are the convolutions with their normalisations and
activations, 151 to 154 are pooling, the linear layer, softmax and output. torchvision's network is the same one, cut
into modules: features[0] is Conv1 (2 to 4), features[1] expanded_conv (5 to 9), features[i] block_i-1, features[18]
Conv_1 (148 to 150). The sum at the end of a block (`add`) is a layer in Matlab and no module here.
"""

import re
from typing import NamedTuple

LAYERS = 154
BLOCKS = 16  # behind expanded_conv
WITHOUT_SUM = (1, 3, 6, 10, 13, 16)  # blocks whose stride or width changes: nothing to add
EXPANDED = (
    ("expand", "0.0"), ("expand_BN", "0.1"), ("expand_relu", "0.2"),
    ("depthwise", "1.0"), ("depthwise_BN", "1.1"), ("depthwise_relu", "1.2"), ("project", "2"), ("project_BN", "3"),
)  # fmt: skip
FIRST = (  # of expanded_conv, which expands nothing
    ("depthwise", "0.0"), ("depthwise_BN", "0.1"), ("depthwise_relu", "0.2"), ("project", "1"), ("project_BN", "2"),
)  # fmt: skip
PLAIN = (("", "0"), ("_bn", "1"), ("_relu", "2"))  # of Conv1 and Conv_1


class Layer(NamedTuple):
    """One layer: Matlab's number (from 1) and name, and the module of a Network that it is; None where it has none."""

    number: int
    name: str
    module: str | None


def layers():
    """The 154 layers of MobileNetV2, in Matlab's order."""
    found = [("input_1", None), *_plain("Conv1", 0), *_block("expanded_conv", 1, FIRST)]
    for i in range(1, BLOCKS + 1):
        found += _block(f"block_{i}", i + 1, EXPANDED)
        found += [] if i in WITHOUT_SUM else [(f"block_{i}_add", None)]
    found += [*_plain("Conv_1", BLOCKS + 2), ("global_average_pooling2d_1", "pool"), ("Logits", "head.1")]
    found += [("Logits_softmax", None), ("ClassificationLayer_Logits", None)]
    return [Layer(number, *layer) for number, layer in enumerate(found, start=1)]


def frozen_modules(layer_range, network):
    """Names of the modules with parameters within a range of layers such as `18:139`, both ends included.

    network: a Network of MobileNetV2; what the range names is looked for in it. Raises ValueError for text that is no
    range, a range beyond the 154 layers, one that leaves nothing to learn, or another network.
    """
    first, last = parse(layer_range)
    if not is_mobilenet_v2(network):
        raise ValueError(f"mode {layer_range}: ranges of layers are those of mobilenet_v2, this is another network")
    wanted = [layer.module for layer in layers() if first <= layer.number <= last and layer.module]
    found = [name for name in wanted if _has_own(network.get_submodule(name))]
    if "head.1" in found:
        raise ValueError(f"mode {layer_range}: layer 152 is the new classifier, which must learn")
    return found


def is_range(mode):
    """True for text that looks like a range of layers, FIRST:LAST."""
    return re.fullmatch(r"\d+:\d+", mode) is not None


def parse(layer_range):
    """(first, last) of a range FIRST:LAST."""
    if not is_range(layer_range):
        raise ValueError(f"{layer_range!r} is no range of layers, such as 18:139")
    first, last = map(int, layer_range.split(":"))
    if not 1 <= first <= last <= LAYERS:
        raise ValueError(f"mode {layer_range}: the layers are 1 to {LAYERS}, first before last")
    return first, last


def is_mobilenet_v2(network):
    """True when every module with parameters is one that the 154 layers name, and none of these is missing."""
    known = {layer.module for layer in layers() if layer.module}
    there = dict(network.named_modules())
    return known <= set(there) and all(name in known for name, module in there.items() if _has_own(module))


def _has_own(module):
    return any(True for _ in module.parameters(recurse=False))


def _plain(name, feature):
    # Matlab calls the last activation out_relu and spells two normalisations in its own way.
    odd = {"Conv1_bn": "bn_Conv1", "Conv_1_relu": "out_relu"}
    return [(odd.get(name + part, name + part), f"convolutions.{feature}.{module}") for part, module in PLAIN]


def _block(name, feature, parts):
    return [(f"{name}_{part}", f"convolutions.{feature}.conv.{module}") for part, module in parts]
