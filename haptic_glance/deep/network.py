"""Networks for photographs with a new classifier: a linear head on standardised features."""

from collections.abc import Sequence

import numpy as np
import torch

from .architectures import alexnet, efficientnet_lite0, googlenet, mobilenet_v2, resnet50, resnet50_v1, resnet101, vgg16
from .architectures import fully_connected as vgg16_layers
from .images import Transform
from .weights import imagenet_state, resolve_source

# `random` gets the statistics of its normalisation from the images, `random_initial` keeps those it begins with.
WEIGHTS = ("imagenet", "random", "random_initial")
UNNORMALISED = ("alexnet", "vgg16")  # networks without normalisation, whose two kinds of random weights are the same
SMALLEST = 32  # pixels a side: with fewer, the last feature maps of some networks are empty


class Network(torch.nn.Module):
    """The convolutions of an architecture with a new head for k classes.

    Maps images (b, 3, h, w) f4, normalised as for ImageNet, to scores (b, k) before the softmax. `features` gives the
    pooled feature maps, (b, width); `head` maps them to the scores. hidden: fully connected layers between the maps,
    pooled to 7 x 7, and the new linear layer on `width` features; None: the mean of each map is classified.
    """

    def __init__(
        self,
        convolutions: torch.nn.Sequential,
        width: int,
        classes: int,
        dropout: float,
        hidden: torch.nn.Sequential | None = None,
    ) -> None:
        super().__init__()
        self.convolutions = convolutions
        self.pool = torch.nn.AdaptiveAvgPool2d(1)
        if hidden is not None:
            self.pool = torch.nn.Sequential(torch.nn.MaxPool2d(2), torch.nn.AdaptiveAvgPool2d(7))
        linear = torch.nn.Linear(width, classes)
        self.head = torch.nn.Sequential(*(hidden or ()), torch.nn.Dropout(dropout), linear)
        torch.nn.init.normal_(linear.weight, std=0.01)  # as torchvision does for MobileNetV2
        torch.nn.init.zeros_(linear.bias)

    def features(self, images: torch.Tensor) -> torch.Tensor:
        """(b, width): the pooled last feature maps. Raises ValueError for images of another shape or too small."""
        if images.ndim != 4 or images.shape[1] != 3 or min(images.shape[2:]) < SMALLEST:
            raise ValueError(
                f"images must have shape (b, 3, h, w) with sides of {SMALLEST} or more, got {tuple(images.shape)}"
            )
        return self.pool(self.convolutions(images)).flatten(1)

    def forward(self, images: torch.Tensor) -> torch.Tensor:
        return self.head(self.features(images))

    def classify(self, maps: torch.Tensor) -> torch.Tensor:
        """(b, k): the scores of last feature maps (b, C, i, j)."""
        return self.head(self.pool(maps).flatten(1))


NETWORKS = {
    "alexnet": alexnet,
    "googlenet": googlenet,
    "vgg16": vgg16,
    "resnet50": resnet50,
    "resnet101": resnet101,
    "mobilenet_v2": mobilenet_v2,
    "efficientnet_lite0": efficientnet_lite0,
}
FULLY_CONNECTED = {"vgg16": (vgg16_layers, 4096)}  # network -> layers before the classifier, and their features
PACKAGE_VARIANTS = {"resnet50": resnet50_v1}  # architectures of a package's weights where torchvision's differ


def build(
    name: str, classes: int, weights: str, seed: int, source: str = "package", fully_connected: bool = False
) -> Network:
    """A Network for `classes` classes, in evaluation mode.

    name: one of NETWORKS. weights: one of WEIGHTS, the random ones for the control. source: where the weights come
    from, one of haptic_glance.deep.weights.SOURCES; it also decides the variant of ResNet50, for the control too. The
    seed decides the initial head and, for random weights, the convolutions; the caller's random numbers are left
    unchanged. fully_connected: keeps the fully connected layers of VGG16, which are random where the source has none
    (see published_layers).
    Raises ValueError for an unknown name, FetchError for weights that are not available.
    """
    if weights not in WEIGHTS:
        raise ValueError(f"unknown weights {weights!r}, known: {', '.join(WEIGHTS)}")
    if classes < 2:
        raise ValueError(f"a classifier needs two classes or more, got {classes}")
    if name not in NETWORKS:
        raise ValueError(f"unknown network {name!r}, known: {', '.join(NETWORKS)}")
    design = NETWORKS[name]
    if resolve_source(name, source) == "package":
        design = PACKAGE_VARIANTS.get(name, design)
    state = imagenet_state(name, source) if weights == "imagenet" else None
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        parts = design(state)
        layers, width = FULLY_CONNECTED.get(name, (None, parts.width)) if fully_connected else (None, parts.width)
        hidden_layers = layers(state) if layers else None
        network = Network(parts.convolutions, width, classes, parts.dropout, hidden_layers)
    # The channels-last layout halves the time of a convolution on a CPU.
    return network.to(memory_format=torch.channels_last).eval()  # pyright: ignore[reportCallIssue] (no overload has it)


def published_layers(name: str, source: str) -> bool:
    """Whether a source has ImageNet's weights of the layers that `fully_connected` keeps; most networks have none."""
    return name not in FULLY_CONNECTED or resolve_source(name, source) == "download"


@torch.no_grad()
def recalibrate(
    network: torch.nn.Module,
    inputs: Transform,
    ids: np.ndarray | torch.Tensor,
    batch: int = 32,
    fixed: Sequence[str] = (),
) -> None:
    """Sets the statistics of the normalisation layers to those of the touches `ids` (n,) i8; inputs(ids): their images.

    fixed: names of modules that keep their statistics, with all modules inside. Uses no labels and changes no weights.
    Raises ValueError for fewer than two touches.

    At the end of a training this replaces the running means, which lag behind the weights in a short training; Matlab's
    trainNetwork, which the thesis used, does the same. An untrained MobileNetV2 maps every image to features below 1e-8
    without it. With it each layer magnifies small differences, so that the deep features of similar images have little
    in common; both are controls (see WEIGHTS). AlexNet and VGG16 have no normalisation layers.
    """
    if len(ids) < 2:
        raise ValueError(f"statistics need two touches or more, got {len(ids)}")
    normalisations = {n: layer for n, layer in network.named_modules() if isinstance(layer, torch.nn.BatchNorm2d)}
    kept = tuple(f"{name}." for name in fixed)
    layers = [layer for name, layer in normalisations.items() if not f"{name}.".startswith(kept)]
    if not layers:
        network.eval()
        return
    momenta = [layer.momentum for layer in layers]
    for layer in layers:
        layer.reset_running_stats()
        layer.momentum = None  # None: the plain mean over all batches
    network.eval()
    for layer in layers:
        layer.train()
    # Shuffled, since ids are sorted by class and a part of one class would be centred on it; with a generator of its
    # own, so that no other random number changes. Parts of equal size, since a part of one image has no variance.
    order = torch.randperm(len(ids), generator=torch.Generator().manual_seed(0))
    for part in torch.as_tensor(ids)[order].tensor_split(-(-len(ids) // batch)):
        network(inputs(part))
    for layer, momentum in zip(layers, momenta, strict=True):
        layer.momentum = momentum
    network.eval()


def count_parameters(module: torch.nn.Module, trained: bool = False) -> int:
    """The number of parameters of a module; with trained=True only of those that are trained."""
    return sum(p.numel() for p in module.parameters() if p.requires_grad or not trained)


DEAD = 1e-6  # of the largest deviation: features that vary less are not scaled


class ScaledHead(torch.nn.Module):
    """A linear head (b, width) -> (b, classes) on features of mean 0 and deviation 1 over the training touches.

    Standardised features let one set of learning rates serve every network: those of an untrained network differ
    between images by a hundredth of their size, and a head on them would learn next to nothing in ten epochs. A linear
    head on standardised features is equivalent to one on the features themselves.
    """

    mean: torch.Tensor
    deviation: torch.Tensor

    def __init__(self, head: torch.nn.Module, width: int) -> None:
        super().__init__()
        self.head = head
        self.register_buffer("mean", torch.zeros(width))
        self.register_buffer("deviation", torch.ones(width))

    def forward(self, features: torch.Tensor) -> torch.Tensor:
        return self.head((features - self.mean) / self.deviation)

    @torch.no_grad()
    def fit(self, features: torch.Tensor) -> None:
        """Sets mean and deviation to those of features (n, width)."""
        spread = features.std(dim=0, correction=0)
        self.mean.copy_(features.mean(dim=0))
        self.deviation.copy_(torch.where(spread > DEAD * spread.max(), spread, 1))
