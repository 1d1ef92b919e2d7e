"""The methods of the stage, and the check of its settings."""

import sys
from dataclasses import dataclass

from stages.kit.fetch import FetchError
from stages.networks import build
from stages.networks.device import choose_device

from .schema import Params

MODES = {  # mode -> the network's initial weights
    "frozen": "imagenet",  # the network keeps ImageNet's weights, a new head per task is trained
    "finetuned": "imagenet",  # every layer is trained, one network per task
    "random": "random",  # the control: an untrained network, of which only the heads are trained
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
    return Method(name, network, mode)


def check(settings: Params) -> None:
    """Raises ValueError for settings that cannot be run."""
    choose_device(settings.device)
    if settings.size < 32 or settings.folds < 2 or not settings.penalties or not settings.methods:
        raise ValueError(
            "fixation: size must be 32 or more, folds 2 or more, and penalties and methods must not be empty"
        )


def available(settings: Params) -> tuple[list[Method], dict[str, str]]:
    """(methods that can run, dict of the others -> reason): methods without available weights are left out."""
    found, missing = [], {}
    for method in [method_named(name) for name in dict.fromkeys(settings.methods)]:
        try:
            build(method.network, 2, MODES[method.mode], 0, settings.source)
            found.append(method)
        except FetchError as error:
            print(f"fixation: {method.name} is left out: {error}", file=sys.stderr)
            missing[method.name] = str(error)
    return found, missing
