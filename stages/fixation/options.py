"""The methods of the stage, and the check of its settings."""

import sys
from dataclasses import dataclass

from haptic_glance.base.fetch import FetchError
from haptic_glance.deep import build
from haptic_glance.deep.device import choose_device
from haptic_glance.deep.network import published_layers

from .schema import Params
from .vertices import PROJECTIONS

MODES = {  # mode -> the network's initial weights
    "frozen": "imagenet",  # the network keeps ImageNet's weights, a new head per task is trained
    "last_block": "imagenet",  # the last block and what follows it is trained, one network per task, on cached maps
    "finetuned": "imagenet",  # every layer is trained, one network per task
    "random": "random",  # the control: an untrained network, of which only the heads are trained
}
TRAINED = ("last_block", "finetuned")  # modes with a network per task
LAST_BLOCK = {  # network -> the first part of its last block, in the order of its convolutions
    "vgg16": 24,  # conv5_1
    "resnet50": 7,  # layer4
    "resnet101": 7,
    "mobilenet_v2": 17,
}


@dataclass(frozen=True)
class Method:
    """A network and the mode in which it is trained."""

    name: str
    network: str
    mode: str


def method_named(name: str) -> Method:
    """The Method of a name NETWORK-MODE; raises ValueError for a name without a known mode."""
    network, _, mode = name.rpartition("-")
    if not network or mode not in MODES:
        raise ValueError(f"fixation.methods: {name!r} is not NETWORK-MODE with mode {', '.join(MODES)}")
    if mode == "last_block" and network not in LAST_BLOCK:
        raise ValueError(f"fixation.methods: {name}: the last block is known of {', '.join(LAST_BLOCK)} alone")
    return Method(name, network, mode)


def check(settings: Params) -> None:
    """Raises ValueError for settings that cannot be run."""
    choose_device(settings.device)
    if settings.projection not in PROJECTIONS:
        raise ValueError(f"fixation.projection must be {' or '.join(PROJECTIONS)}, got {settings.projection!r}")
    if settings.size < 32 or settings.folds < 2 or not (settings.penalties and settings.rates and settings.methods):
        raise ValueError(
            "fixation: size must be 32 or more, folds 2 or more, and penalties, rates and methods must not be empty"
        )


def available(settings: Params) -> tuple[list[Method], dict[str, str]]:
    """(methods that can run, dict of the others -> reason): methods without available weights are left out."""
    found, missing = [], {}
    for method in [method_named(name) for name in dict.fromkeys(settings.methods)]:
        try:
            build(method.network, 2, MODES[method.mode], 0, settings.source)
            found.append(method)
            if method.mode == "last_block" and not published_layers(method.network, settings.source):
                print(f"fixation: {method.name}: no package registry has ImageNet's weights of the fully connected "
                      "layers, they start at random: set fixation.source=download on a machine with a network",
                      file=sys.stderr)  # fmt: skip
        except FetchError as error:
            print(f"fixation: {method.name} is left out: {error}", file=sys.stderr)
            missing[method.name] = str(error)
    return found, missing
