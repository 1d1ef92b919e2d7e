"""Architectures of networks: the convolutions up to the last feature maps.

This module also imports torchvision for the whole project. torchvision's compiled operators are linked against one
build of torch. With another build (usual for the PyPI wheel of torchvision and a CPU wheel of torch) the operators do
not load, and `import torchvision` fails with `operator torchvision::nms does not exist`. Models, transforms and weights
need none of the operators. After that failure, and no other, their schemas are declared here and the import is
repeated. Calling the operators remains an error.
"""

import importlib
import sys
from collections import OrderedDict
from collections.abc import Mapping
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import torch

SCHEMAS = (  # as torchvision registers them in C++: ops/nms.cpp, ops/quantized/cpu/qnms_kernel.cpp
    "nms(Tensor dets, Tensor scores, float iou_threshold) -> Tensor",
    "qnms(Tensor dets, Tensor scores, float iou_threshold) -> Tensor",
)
_declared: list[torch.library.Library] = []  # a Library withdraws its declarations when it is deleted


def load() -> ModuleType:
    """The imported torchvision; raises ImportError, with the remedy, where it cannot be imported."""
    try:
        return importlib.import_module("torchvision")
    except RuntimeError as error:
        if "torchvision::" not in str(error) or "does not exist" not in str(error) or _declared:
            raise ImportError(
                f"torchvision cannot be imported with torch {torch.__version__}: {error}. "
                "Install the releases of both that constraints.txt names."
            ) from error
    _drop_half_imported()
    _declare()
    return importlib.import_module("torchvision")


def _drop_half_imported():
    for name in [name for name in sys.modules if name.partition(".")[0] == "torchvision"]:
        del sys.modules[name]


def _declare():
    library = torch.library.Library("torchvision", "FRAGMENT")
    for schema in SCHEMAS:
        library.define(schema)
    _declared.append(library)


torchvision = load()


def restore(module: torch.nn.Module, state: Mapping[str, Any], name: str) -> None:
    """Loads a state {parameter or buffer: tensor or array} into a module, whose entries it must match exactly.

    name: of the network, for messages. The number of batches that normalisation layers count may be absent, since some
    libraries do not store it. Raises ValueError for weights of another architecture, naming the first
    entry that does not fit, and for values that are not finite.
    """
    entries = module.state_dict()
    try:
        tensors = {key: _tensor(value) for key, value in dict(state).items()}
    except (TypeError, ValueError) as error:
        raise ValueError(f"these are not weights of {name}: {error}") from None
    _compare({key: tuple(value.shape) for key, value in entries.items()}, tensors, name)
    for key, value in tensors.items():
        if not bool(value.isfinite().all()):
            raise ValueError(f"the weights of {name} are damaged: {key} holds values that are not finite")
    module.load_state_dict(tensors, strict=False)


def _compare(shapes, tensors, name):
    missing = [key for key in shapes if key not in tensors and not key.endswith("num_batches_tracked")]
    unexpected = [key for key in tensors if key not in shapes]
    misfits = [key for key in tensors if key in shapes and tuple(tensors[key].shape) != shapes[key]]
    if not (missing or unexpected or misfits):
        return
    reasons = [f"{key} is {tuple(tensors[key].shape)} instead of {shapes[key]}" for key in misfits[:1]]
    reasons += [
        f"{len(keys)} {kind}, first {keys[0]}"
        for kind, keys in (("missing", missing), ("unexpected", unexpected))
        if keys
    ]
    raise ValueError(f"these are not weights of {name}: {'; '.join(reasons)}")


def _tensor(value):
    return value.detach() if isinstance(value, torch.Tensor) else torch.as_tensor(np.asarray(value))


class Architecture(NamedTuple):
    """The convolutions of a network, from images (b, 3, h, w) to the last feature maps (b, width, i, j).

    dropout: the share dropped before the classifier.
    """

    convolutions: torch.nn.Sequential
    width: int
    dropout: float


def he_initialise(module: torch.nn.Module) -> None:
    """Initialises convolutions and linear layers with He's distribution (He et al. 2015) and zero biases.

    For networks without normalisation layers: with torch's own initialisation the signal shrinks at each layer.
    """
    for layer in module.modules():
        if isinstance(layer, torch.nn.Conv2d | torch.nn.Linear):
            torch.nn.init.kaiming_normal_(layer.weight, mode="fan_in", nonlinearity="relu")
            if layer.bias is not None:
                torch.nn.init.zeros_(layer.bias)


def alexnet(state: dict[str, torch.Tensor] | None) -> Architecture:
    """AlexNet's Architecture. state: {`features.N.weight` or `.bias`: tensor}, with or without `classifier.*`, or None.

    The convolutions end at the rectified fifth one, without the last max pooling: 256 maps of 13 x 13 at 224 pixels.
    The thesis keeps the fully connected layers fc6 and fc7 and replaces fc8. No package registry has their weights, so
    here the maps are averaged and classified by one new layer, which has 2.5 of 61 million parameters and takes any
    size.
    """
    with torch.device("meta"):  # so that the 59 million other parameters are not initialised
        convolutions = torchvision.models.alexnet().features[:-1]
    convolutions.to_empty(device="cpu")
    if state is None:
        he_initialise(convolutions)
    else:
        restore(convolutions, features_of(state), "alexnet's convolutions")
    return Architecture(convolutions, width=256, dropout=0.5)


def features_of(state: dict[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """The weights of the convolutions among those of a torchvision network, without their prefix."""
    return {key.removeprefix("features."): value for key, value in state.items() if not key.startswith("classifier.")}


PUBLISHED = [f"classifier.{layer}.{kind}" for layer in (0, 3) for kind in ("weight", "bias")]  # fc6 and fc7


def vgg16(state: dict[str, torch.Tensor] | None) -> Architecture:
    """VGG16's Architecture. state: {`features.N.weight` or `.bias`: tensor}, with or without `classifier.*`, or None.

    The convolutions end at the rectified thirteenth one, without the last max pooling: 512 maps of 14 x 14 at 224
    pixels, which Grad-CAM uses. The thesis keeps the fully connected layers fc6 and fc7 and replaces fc8. No package
    registry has their weights, so the maps are averaged and classified by one new layer, 14.7 of 138 million
    parameters, unless `fully_connected` is asked for.
    """
    vgg = torchvision.models.vgg
    convolutions = vgg.make_layers(vgg.cfgs["D"])[:-1]  # so that the 124 million other parameters are not initialised
    if state is None:
        he_initialise(convolutions)
    else:
        restore(convolutions, features_of(state), "vgg16's convolutions")
    return Architecture(convolutions, width=512, dropout=0.5)


def fully_connected(state: dict[str, torch.Tensor] | None) -> torch.nn.Sequential:
    """VGG16's layers fc6 and fc7, from the last maps, pooled to 7 x 7, to 4096 features.

    state: as of `vgg16`. Without `classifier.*`, as from a package registry, their 119 million weights are random.
    """
    layers = torch.nn.Sequential(
        torch.nn.Linear(512 * 7 * 7, 4096), torch.nn.ReLU(), torch.nn.Dropout(0.5),
        torch.nn.Linear(4096, 4096), torch.nn.ReLU(),
    )  # fmt: skip
    published = {key.removeprefix("classifier."): value for key, value in (state or {}).items() if key in PUBLISHED}
    if published:
        restore(layers, published, "vgg16's fully connected layers")
    else:
        he_initialise(layers)
    return layers


def googlenet(state: dict[str, torch.Tensor] | None) -> Architecture:
    """GoogLeNet's Architecture: 1024 maps of 7 x 7 at 224 pixels.

    state: torchvision's weights without the auxiliary classifiers, or None.
    """
    whole = torchvision.models.googlenet(aux_logits=False, transform_input=False, init_weights=True)
    return _parts(whole, state, "googlenet", dropout=0.2)


def mobilenet_v2(state: dict[str, torch.Tensor] | None) -> Architecture:
    """MobileNetV2's Architecture: 1280 maps of 7 x 7 at 224 pixels. state: torchvision's weights, or None."""
    whole = torchvision.models.mobilenet_v2()
    if state is not None:
        restore(whole, state, "mobilenet_v2")
    return Architecture(whole.features, width=whole.last_channel, dropout=0.2)


def resnet50(state: dict[str, torch.Tensor] | None) -> Architecture:
    """ResNet50's Architecture: 2048 maps of 7 x 7 at 224 pixels. state: torchvision's weights, or None."""
    return _parts(torchvision.models.resnet50(), state, "resnet50")


def resnet50_v1(state: dict[str, torch.Tensor] | None) -> Architecture:
    """The Architecture of the original ResNet50 (v1), as in the paper, Keras and Matlab.

    Each stage halves the maps in its first 1 x 1 convolution; torchvision (v1.5) does so in the 3 x 3 one. state:
    weights by torchvision's names, or None.
    """
    whole = torchvision.models.resnet50()
    for stage in (whole.layer2, whole.layer3, whole.layer4):
        stage[0].conv1.stride, stage[0].conv2.stride = (2, 2), (1, 1)
    return _parts(whole, state, "resnet50")


def resnet101(state: dict[str, torch.Tensor] | None) -> Architecture:
    """ResNet101's Architecture: 2048 maps of 7 x 7 at 224 pixels. state: torchvision's weights, or None."""
    return _parts(torchvision.models.resnet101(), state, "resnet101")


TAIL = ("aux1", "aux2", "avgpool", "dropout", "fc")  # what follows the convolutions


def _parts(whole, state, name, dropout=0.0):
    if state is not None:
        restore(whole, state, name)
    layers = OrderedDict((name, layer) for name, layer in whole.named_children() if name not in TAIL)
    return Architecture(torch.nn.Sequential(layers), whole.fc.in_features, dropout)


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
    convolutions = network["convolutions"]
    assert isinstance(convolutions, torch.nn.Sequential)
    return Architecture(convolutions, WIDTH, dropout=0.2)


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
