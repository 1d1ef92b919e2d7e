"""Lower precision for the weights of a network in a file: half precision, or eight bits with a scale per channel.

The weights are unpacked to float32 when the network is loaded. So the file is smaller, but the network needs as much
memory and time, and no engine for quantised arithmetic.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

SCALE = ".scale"  # suffix of the name of the scales of an int8 array
LEVELS = 127  # largest int8; symmetric, so that -128 is not used


class Precision(NamedTuple):
    """The packing of a dict of float32 arrays for a file, and its unpacking to float32."""

    pack: Callable[[dict], dict]
    unpack: Callable[[dict], dict]


def to_half(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The arrays as float16; raises ValueError where a value is too large for it."""
    found = {}
    for key, values in arrays.items():
        if np.abs(values).max(initial=0) > np.finfo(np.float16).max:
            raise ValueError(f"{key} does not fit in half precision: {np.abs(values).max():.3g}")
        found[key] = values.astype(np.float16)
    return found


def to_single(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The arrays as float32."""
    return {key: values.astype(np.float32) for key, values in arrays.items()}


def quantise(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Weights (arrays with two or four axes) as int8, with a float32 scale for each index of the first axis.

    Symmetric, per output channel, rounded to nearest (Krishnamoorthi 2018, Quantizing deep convolutional networks,
    section 3.1). Biases, normalisation and temperatures stay float32: they are few, and each affects a whole channel.
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


def dequantise(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The float32 arrays that `quantise` packed."""
    scales = {key.removesuffix(SCALE): values for key, values in arrays.items() if key.endswith(SCALE)}
    plain = {key: values for key, values in arrays.items() if not key.endswith(SCALE)}
    return {key: values.astype(np.float32) * scales.get(key, np.float32(1)) for key, values in plain.items()}


PRECISIONS = {
    "float32": Precision(to_single, to_single),
    "float16": Precision(to_half, to_single),
    "int8": Precision(quantise, dequantise),
}
