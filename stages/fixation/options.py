"""The settings of a run, checked, and what the stage's steps need of them."""

import sys
from dataclasses import dataclass

from stages.kit.fetch import FetchError
from stages.networks import build
from stages.networks.device import choose

MODES = {  # what the network starts from
    "frozen": "imagenet",  # it keeps ImageNet's weights, heads of its own learn the tasks
    "finetuned": "imagenet",  # every layer learns, one network a task
    "random": "random",  # the control: it never learned anything but its heads
}


@dataclass(frozen=True)
class Method:
    """One way to a map: a network and what of it learns."""

    name: str
    network: str
    mode: str


def method_named(name):
    """The Method of NETWORK-MODE; ValueError for a name without a known mode."""
    network, _, mode = name.rpartition("-")
    if not network or mode not in MODES:
        raise ValueError(f"fixation.methods: {name!r} is no NETWORK-MODE with mode {', '.join(MODES)}")
    return Method(name, network, mode)


def checked(settings):
    """Raises ValueError for settings that no run can have."""
    choose(settings.device)
    if settings.size < 32 or settings.folds < 2 or not settings.penalties or not settings.methods:
        raise ValueError("fixation: size must be 32 or more, folds 2 or more, penalties and methods name at least one")


def available(settings):
    """(methods that can run, dict method -> why not): those whose weights cannot be had are left out with a word."""
    found, missing = [], {}
    for method in [method_named(name) for name in dict.fromkeys(settings.methods)]:
        try:
            build(method.network, 2, MODES[method.mode], 0, settings.source)
            found.append(method)
        except FetchError as error:
            print(f"fixation: {method.name} is left out: {error}", file=sys.stderr)
            missing[method.name] = str(error)
    return found, missing
