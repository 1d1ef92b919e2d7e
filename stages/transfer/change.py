"""How much training has altered each convolution (T5.4, figure 5.4)."""

import re

import numpy as np
import torch

from stages.networks.layers import is_mobilenet_v2, layers


def weight_changes(before, after):
    """{name of a convolution: mean squared difference of its weights} of two networks of the same architecture.

    The weights of each layer, before and after alone, are first scaled to 0..1 by their own least and greatest (T5.4);
    of a layer whose weights are all alike they are 0. Grouped convolutions count like others; biases do not. In the
    order of the network.
    """
    trained = dict(after.named_modules())
    convolutions = {n: layer for n, layer in before.named_modules() if isinstance(layer, torch.nn.Conv2d)}
    return {
        name: float(np.mean((_scaled(layer.weight) - _scaled(trained[name].weight)) ** 2))
        for name, layer in convolutions.items()
    }


def parts(network):
    """{name of a convolution: its part of the network}.

    Of MobileNetV2 the block that Matlab's layer belongs to (Conv1, expanded_conv, block_1, ...), of others conv_1,
    conv_2 and so on from the image to the classes.
    """
    names = [name for name, layer in network.named_modules() if isinstance(layer, torch.nn.Conv2d)]
    if not is_mobilenet_v2(network):
        return {name: f"conv_{i}" for i, name in enumerate(names, start=1)}
    known = {layer.module: layer.name for layer in layers()}
    return {name: re.sub("_(expand|depthwise|project)$", "", known[name]) for name in names}


def _scaled(weight):
    values = weight.detach().cpu().double().numpy()
    low, high = values.min(), values.max()
    return (values - low) / (high - low) if high > low else np.zeros_like(values)
