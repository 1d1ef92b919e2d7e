"""VGG16 (Simonyan & Zisserman 2015, T [235]): its convolutions, and its fully connected layers."""

import torch

from ..restore import restore
from ..torchvision_import import torchvision
from .alexnet import features_of
from .architecture import Architecture, he_initialise

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
    return Architecture(convolutions, width=512, dropout=0.5, classifier=None)


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
