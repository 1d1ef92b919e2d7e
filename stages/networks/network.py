"""Networks whose classification layers are replaced by new ones for the classes of touch."""

import torch

from .architectures.alexnet import alexnet
from .architectures.efficientnet_lite0 import efficientnet_lite0
from .architectures.googlenet import googlenet
from .architectures.mobilenet_v2 import mobilenet_v2
from .architectures.resnet import resnet50, resnet50_early, resnet101
from .architectures.vgg16 import vgg16
from .weights import chosen, had, imagenet_state

START = ("imagenet", "random")
SMALLEST = 32  # pixels: below, some of the networks have no last map left


class Network(torch.nn.Module):
    """Convolutions made for photographs and a new head for k classes of imprints.

    Images (b, 3, h, w) f4, ImageNet-normalised, to scores (b, k) before the softmax. `features` gives what the head
    sees, (b, width); `head` maps it to the scores.
    """

    def __init__(self, convolutions, width, classes, dropout):
        super().__init__()
        self.convolutions = convolutions
        self.pool = torch.nn.AdaptiveAvgPool2d(1)
        self.head = torch.nn.Sequential(torch.nn.Dropout(dropout), torch.nn.Linear(width, classes))
        torch.nn.init.normal_(self.head[1].weight, std=0.01)  # as torchvision does for MobileNetV2
        torch.nn.init.zeros_(self.head[1].bias)

    def features(self, images):
        """(b, width): the pooled last convolution. Raises ValueError for images of another shape or too small."""
        if images.ndim != 4 or images.shape[1] != 3 or min(images.shape[2:]) < SMALLEST:
            raise ValueError(
                f"images must have shape (b, 3, h, w) with sides of {SMALLEST} or more, got {tuple(images.shape)}"
            )
        return self.pool(self.convolutions(images)).flatten(1)

    def forward(self, images):
        return self.head(self.features(images))


NETWORKS = {
    "alexnet": alexnet,
    "googlenet": googlenet,
    "vgg16": vgg16,
    "resnet50": resnet50,
    "resnet101": resnet101,
    "mobilenet_v2": mobilenet_v2,
    "efficientnet_lite0": efficientnet_lite0,
}
EARLY = {"resnet50": resnet50_early}  # what a registry's weights fit where they are not torchvision's


def build(name, classes, weights, seed, source="package"):
    """A Network for `classes` classes, in evaluation mode.

    name: one of NETWORKS. weights: `imagenet`, or `random` for the control. source: `package` or `download`, where the
    weights come from; it also says which form of ResNet50 they and their control have. The seed fixes the head and,
    for `random`, the convolutions; the caller's own random numbers are left as they were. Raises ValueError for an
    unknown name, FetchError for weights that cannot be had.
    """
    if weights not in START:
        raise ValueError(f"unknown weights {weights!r}, known: {', '.join(START)}")
    if classes < 2:
        raise ValueError(f"a classifier needs two classes or more, got {classes}")
    design = _design(name, source)
    state = imagenet_state(name, source) if weights == "imagenet" else None
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        parts = design(state)
        network = Network(parts.convolutions, parts.width, classes, parts.dropout)
    return _ready(network)


def imagenet_classifier(name, source="package"):
    """The Network of ImageNet's 1000 classes, in torchvision's order of categories, with the published head.

    Raises ValueError where there is none: AlexNet and VGG16 have more layers behind their convolutions than a Network
    does; FetchError for weights that cannot be had.
    """
    if had(name, source) == "convolutions":
        raise ValueError(f"{name} has its convolutions alone here, and no classifier of ImageNet's classes")
    state = imagenet_state(name, source)
    with torch.random.fork_rng(devices=[]):
        parts = _design(name, source)(state)
        network = Network(parts.convolutions, parts.width, parts.classifier.out_features, parts.dropout)
    network.head[1].load_state_dict(parts.classifier.state_dict())
    return _ready(network)


def _design(name, source):
    if name not in NETWORKS:
        raise ValueError(f"unknown network {name!r}, known: {', '.join(NETWORKS)}")
    return EARLY.get(name, NETWORKS[name]) if chosen(name, source) == "package" else NETWORKS[name]


def _ready(network):
    # Channels last halves the time of a convolution on a CPU and changes no result's shape.
    return network.to(memory_format=torch.channels_last).eval()


@torch.no_grad()
def settle(network, inputs, ids, batch=32, fixed=()):
    """Gives the normalisation layers the statistics of the touches `ids` (n,) i8; inputs(ids) gives their images.

    fixed: names of modules that keep theirs. Raises ValueError for less than two touches.

    No label is used and no weight changes. Done at the end of a training, as Matlab's trainNetwork, which the thesis
    used, does: the running means of a short training lag behind its weights. And done to an untrained network, since
    the control would fail otherwise for a reason that has nothing to do with transfer: in evaluation mode an untrained
    MobileNetV2 shrinks every image to features below 1e-8. AlexNet and VGG16 have no such layers and stay as they are;
    their untrained start keeps the signal (architectures.parts.he_start).
    """
    if len(ids) < 2:
        raise ValueError(f"statistics need two touches or more, got {len(ids)}")
    normalisations = {n: layer for n, layer in network.named_modules() if isinstance(layer, torch.nn.BatchNorm2d)}
    layers = [layer for name, layer in normalisations.items() if name not in fixed]
    usual = [layer.momentum for layer in layers]
    for layer in layers:
        layer.reset_running_stats()
        layer.momentum = None  # torch's way to say: the plain mean over all batches
    network.eval()
    for layer in layers:
        layer.train()
    # Shuffled, since ids come class by class, and a part of one class alone would be centred on that class; by a
    # generator of its own, so that no other draw changes. Parts of even size: a rest of one image has no variance.
    order = torch.randperm(len(ids), generator=torch.Generator().manual_seed(0))
    for part in torch.as_tensor(ids)[order].tensor_split(-(-len(ids) // batch)):
        network(inputs(part))
    for layer, momentum in zip(layers, usual, strict=True):
        layer.momentum = momentum
    network.eval()


def parameters(module, trained=False):
    """Number of parameters of a module; with trained=True those that learn alone."""
    return sum(p.numel() for p in module.parameters() if p.requires_grad or not trained)
