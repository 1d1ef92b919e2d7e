"""Smaller numbers for the weights of a network on disk: half precision, or eight bits with a scale a channel.

What is stored is what the network then computes with: the weights are unpacked to float32 when it is loaded, so it is
smaller in a file and on a line, not in memory and not faster. Neither needs an engine for quantised arithmetic.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

SCALE = ".scale"  # ends the name of the array of an int8 array's scales
LEVELS = 127  # largest int8; symmetric, so -128 stays unused


class Kind(NamedTuple):
    """How a dict of float32 arrays is packed for a file, and unpacked to float32 again."""

    pack: Callable[[dict], dict]
    unpack: Callable[[dict], dict]


def half(arrays):
    """The arrays as float16; raises ValueError where a value is too large for it."""
    found = {}
    for key, values in arrays.items():
        if np.abs(values).max(initial=0) > np.finfo(np.float16).max:
            raise ValueError(f"{key} does not fit into half precision: {np.abs(values).max():.3g}")
        found[key] = values.astype(np.float16)
    return found


def whole(arrays):
    """The arrays as float32."""
    return {key: values.astype(np.float32) for key, values in arrays.items()}


def quantise(arrays):
    """Weights (two axes or more, so that there is a channel) as int8 with a float32 scale for each first index.

    Symmetric, per output channel, rounded to nearest (Krishnamoorthi 2018, Quantizing deep convolutional networks,
    section 3.1). Biases, normalisation and temperatures stay float32: they are few, and each moves a whole channel.
    """
    found = {}
    for key, values in arrays.items():
        found[key] = values
        if values.ndim in (2, 4):
            scale = np.abs(values).max(axis=tuple(range(1, values.ndim)), keepdims=True).astype(np.float32) / LEVELS
            steps = np.divide(values, scale, out=np.zeros_like(values), where=scale > 0)
            found[key] = np.rint(steps).astype(np.int8)
            found[key + SCALE] = scale
    return found


def dequantise(arrays):
    """The float32 arrays that `quantise` packed."""
    scales = {key.removesuffix(SCALE): values for key, values in arrays.items() if key.endswith(SCALE)}
    plain = {key: values for key, values in arrays.items() if not key.endswith(SCALE)}
    return {key: values.astype(np.float32) * scales.get(key, np.float32(1)) for key, values in plain.items()}


KINDS = {"float32": Kind(whole, whole), "float16": Kind(half, whole), "int8": Kind(quantise, dequantise)}
