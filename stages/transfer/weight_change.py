"""The change of each convolution by training (T5.4, figure 5.4)."""

import re

import numpy as np
import torch

from haptic_glance.deep.modes import is_mobilenet_v2, layers


def weight_changes(before: torch.nn.Module, after: torch.nn.Module) -> dict[str, float]:
    """{name of a convolution: mean squared difference of its weights} of two networks of the same architecture.

    The weights of each layer are first scaled to 0..1, before and after separately (T5.4); equal weights become 0.
    Grouped convolutions are included, biases are not. In the order of the network.
    """
    trained = dict(after.named_modules())
    convolutions = {n: layer for n, layer in before.named_modules() if isinstance(layer, torch.nn.Conv2d)}
    return {
        name: float(np.mean((_scaled(layer.weight) - _scaled(trained[name].weight)) ** 2))
        for name, layer in convolutions.items()
    }


def network_parts(network: torch.nn.Module) -> dict[str, str]:
    """{name of a convolution: the part of the network that it belongs to}.

    In MobileNetV2 this is the block of Matlab's layer (Conv1, expanded_conv, block_1, ...); in other networks conv_1,
    conv_2 and so on, from the input to the output.
    """
    names = [name for name, layer in network.named_modules() if isinstance(layer, torch.nn.Conv2d)]
    if not is_mobilenet_v2(network):
        return {name: f"conv_{i}" for i, name in enumerate(names, start=1)}
    matlab = {layer.module: layer.name for layer in layers()}
    return {name: re.sub("_(expand|depthwise|project)$", "", matlab[name]) for name in names}


def _scaled(weight):
    values = weight.detach().cpu().double().numpy()
    low, high = values.min(), values.max()
    return (values - low) / (high - low) if high > low else np.zeros_like(values)
