"""Networks whose classification layers are replaced by new ones for the classes of touch."""

import torch

from .vision import torchvision
from .weights import imagenet_state

START = ("imagenet", "random")


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
        """(b, width): the pooled last convolution."""
        return self.pool(self.convolutions(images)).flatten(1)

    def forward(self, images):
        return self.head(self.features(images))


def mobilenet_v2(classes, state=None):
    """MobileNetV2 (Sandler et al. 2018, T [269]) with a head for `classes`; state: torchvision's weights or None."""
    whole = torchvision.models.mobilenet_v2()
    if state is not None:
        _load(whole, state, "mobilenet_v2")
    return Network(whole.features, whole.last_channel, classes, dropout=0.2)


NETWORKS = {"mobilenet_v2": mobilenet_v2}


def build(name, classes, weights, seed, source="package"):
    """A Network for `classes` classes, in evaluation mode.

    weights: `imagenet`, or `random` for the control. The seed fixes the head and, for `random`, the convolutions; the
    caller's own random numbers are left as they were. Raises ValueError for an unknown name.
    """
    if name not in NETWORKS:
        raise ValueError(f"unknown network {name!r}, known: {', '.join(NETWORKS)}")
    if weights not in START:
        raise ValueError(f"unknown weights {weights!r}, known: {', '.join(START)}")
    if classes < 2:
        raise ValueError(f"a classifier needs two classes or more, got {classes}")
    state = imagenet_state(name, source) if weights == "imagenet" else None
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        network = NETWORKS[name](classes, state)
    # Channels last halves the time of a convolution on a CPU and changes no result's shape.
    return network.to(memory_format=torch.channels_last).eval()


@torch.no_grad()
def settle(network, inputs, ids, batch=32):
    """Gives the normalisation layers the statistics of the touches `ids` (n,) i8; inputs(ids) gives their images.

    No label is used and no weight changes. Done at the end of a training, as Matlab's trainNetwork, which the thesis
    used, does: the running means of a short training lag behind its weights. And done to an untrained network, since
    the control would fail otherwise for a reason that has nothing to do with transfer: in evaluation mode an untrained
    MobileNetV2 shrinks every image to features below 1e-8.
    """
    layers = [layer for layer in network.modules() if isinstance(layer, torch.nn.BatchNorm2d)]
    usual = [layer.momentum for layer in layers]
    for layer in layers:
        layer.reset_running_stats()
        layer.momentum = None  # torch's way to say: the plain mean over all batches
    network.train()
    # Parts of even size: a rest of one image has no variance.
    for part in torch.as_tensor(ids).tensor_split(-(-len(ids) // batch)):
        network(inputs(part))
    for layer, momentum in zip(layers, usual, strict=True):
        layer.momentum = momentum
    network.eval()


def parameters(module, trained=False):
    """Number of parameters of a module; with trained=True those that learn alone."""
    return sum(p.numel() for p in module.parameters() if p.requires_grad or not trained)


def _load(network, state, name):
    try:
        network.load_state_dict(state)
    except (RuntimeError, TypeError, AttributeError) as error:
        raise ValueError(f"these are no weights of {name}: {str(error).splitlines()[0]}") from None
