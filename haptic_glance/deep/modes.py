"""Ways to train a network: the head alone on cached features, all layers, or all but a range of layers (T5.3, T5.5).

Ranges of MobileNetV2 use the numbers of Matlab's layers, as T table 5.6 does. Matlab's `mobilenetv2` has 154 layers: 1
is the input, 2 to 150 are the convolutions with their normalisations and activations, 151 to 154 are pooling, the
linear layer, softmax and output. torchvision divides the same network into modules: features[0] is Conv1 (2 to 4),
features[1] expanded_conv (5 to 9), features[i] block_i-1, features[18] Conv_1 (148 to 150). The sum at the end of a
block (`add`) is a layer in Matlab and not a module of torchvision.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import torch

from .device import device_of, explain_out_of_memory, mixed_precision
from .images import Transform, augmentation, normalise, to_images
from .network import Network, ScaledHead, recalibrate


@dataclass(frozen=True)
class Task:
    """The model that a mode trains, and its inputs.

    training_inputs(ids) gives the augmented inputs of touches (b,) i8, by torch's random numbers; inputs(ids) the
    inputs without augmentation; encode(images) the inputs of other images (k, 3, size, size) in 0..1. begin(model, ids)
    is called before training on the touches ids, finish(model, ids) after it. fixed: names of the model's modules that
    stay in evaluation mode, so that their statistics do not change.
    """

    model: torch.nn.Module
    training_inputs: Transform
    inputs: Transform
    finish: Callable[[torch.nn.Module, torch.Tensor], None]
    encode: Transform
    fixed: tuple[str, ...] = ()
    begin: Callable[[torch.nn.Module, torch.Tensor], None] = lambda model, ids: None


Mode = Callable[[Network, np.ndarray, int, int], Task]  # of network, imprints, size, copies


def frozen(network: Network, imprints: np.ndarray | list[np.ndarray], size: int, copies: int) -> Task:
    """The Task to train the head alone on the frozen network's features of imprints (k, r, c).

    The network stays in evaluation mode, so that neither its convolutions nor the statistics of their normalisation
    change. Therefore each image's features are computed once and cached. Cached features cannot be augmented, so a few
    augmented copies of each image (`copies`) are cached beside the original, and each step draws among them. The head
    gets them standardised over the training touches.
    """
    network.eval().requires_grad_(False).head.requires_grad_(True)
    images, augment = to_images(imprints, size).to(device_of(network)), augmentation()
    plain = features(network, images)
    cached = torch.stack([plain, *(features(network, images, augment) for _ in range(copies))])

    def drawn(ids):
        return cached[torch.randint(len(cached), (len(ids),)), ids]

    def encode(batch):
        return features(network, batch.to(plain.device))

    def begin(model, ids):
        model.fit(plain[ids])

    model = ScaledHead(network.head, plain.shape[1]).to(plain.device)
    return Task(model, drawn, lambda ids: plain[ids], lambda head, ids: None, encode, begin=begin)


def finetuned(network: Network, imprints: np.ndarray | list[np.ndarray], size: int, copies: int) -> Task:
    """The Task to train every layer on imprints (k, r, c), augmented again at every step; `copies` is not used."""
    return _imprints(network, imprints, size, ())


def layer_range(name: str) -> Mode:
    """The mode that freezes a range of layers of MobileNetV2 in Matlab's numbers, such as `18:139` (T table 5.6)."""

    def mode(network, imprints, size, copies):
        return _imprints(network, imprints, size, tuple(frozen_modules(name, network)))

    mode.__doc__ = f"The Task to train all layers except {name}."
    return mode


def _imprints(network, imprints, size, fixed):
    return finetuned_except(network, to_images(imprints, size).to(device_of(network)), augmentation(), fixed)


def finetuned_except(network: Network, images: torch.Tensor, augment: Transform, fixed: tuple[str, ...]) -> Task:
    """The Task to train all modules except those named `fixed`, whose weights and statistics stay unchanged.

    images (k, 3, h, w) in 0..1 on the network's device; augment: applied to them in training.
    """
    network.requires_grad_(True)
    for name in fixed:
        network.get_submodule(name).requires_grad_(False)

    def inputs(ids):
        return normalise(images[ids])

    def encode(batch):
        return normalise(batch.to(images.device))

    def finish(model, ids):
        recalibrate(model, inputs, ids, fixed=fixed)

    return Task(network, lambda ids: normalise(augment(images[ids])), inputs, finish, encode, fixed)


MODES: dict[str, Mode] = {"frozen": frozen, "finetuned": finetuned}


def mode_named(name: str) -> Mode:
    """The function of a mode: a name of MODES or a range of layers; raises ValueError for another."""
    if is_range(name):
        return layer_range(name)
    if name not in MODES:
        raise ValueError(f"unknown mode {name!r}, known: {', '.join(MODES)}, and ranges of layers such as 18:139")
    return MODES[name]


@torch.no_grad()
def features(network: Network, images: torch.Tensor, augment: Transform | None = None, batch: int = 32) -> torch.Tensor:
    """(k, width) f4: the network's features of images (k, 3, h, w) in 0..1, each batch first passed to `augment`."""
    batches = []
    for part in images.split(batch):
        with explain_out_of_memory():
            inputs = normalise(part if augment is None else augment(part))  # in full precision, as in training
            with mixed_precision(images.device):
                batches.append(network.features(inputs).float())
    return torch.cat(batches)


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
    entries = [("input_1", None), *_plain("Conv1", 0), *_block("expanded_conv", 1, FIRST)]
    for i in range(1, BLOCKS + 1):
        entries += _block(f"block_{i}", i + 1, EXPANDED)
        entries += [] if i in WITHOUT_SUM else [(f"block_{i}_add", None)]
    entries += [*_plain("Conv_1", BLOCKS + 2), ("global_average_pooling2d_1", "pool"), ("Logits", "head.1")]
    entries += [("Logits_softmax", None), ("ClassificationLayer_Logits", None)]
    return [Layer(number, *layer) for number, layer in enumerate(entries, start=1)]


def frozen_modules(layer_range: str, network: torch.nn.Module) -> list[str]:
    """Names of the modules with parameters within a range of layers such as `18:139`, both ends included.

    network: a Network of MobileNetV2. Raises ValueError for text that is not a range, a range beyond the 154 layers,
    one that includes the new classifier, or another network.
    """
    first, last = parse_range(layer_range)
    if not is_mobilenet_v2(network):
        raise ValueError(f"mode {layer_range}: ranges of layers need mobilenet_v2, this is another network")
    candidates = [layer.module for layer in layers() if first <= layer.number <= last and layer.module]
    modules = [name for name in candidates if _has_parameters(network.get_submodule(name))]
    if "head.1" in modules:
        raise ValueError(f"mode {layer_range}: layer 152 is the new classifier, which must be trained")
    return modules


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
    expected = {layer.module for layer in layers() if layer.module}
    modules = dict(network.named_modules())
    return expected <= set(modules) and all(
        name in expected for name, module in modules.items() if _has_parameters(module)
    )


def _has_parameters(module):
    return any(True for _ in module.parameters(recurse=False))


def _plain(name, feature):
    # Matlab names these two layers in another way.
    odd = {"Conv1_bn": "bn_Conv1", "Conv_1_relu": "out_relu"}
    return [(odd.get(name + part, name + part), f"convolutions.{feature}.{module}") for part, module in PLAIN]


def _block(name, feature, parts):
    return [(f"{name}_{part}", f"convolutions.{feature}.conv.{module}") for part, module in parts]
