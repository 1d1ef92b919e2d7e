"""The trainings of a run, and what is left out, with the reason."""

import itertools
from collections.abc import Mapping, Sequence
from typing import NamedTuple, Self

from haptic_glance.base.fetch import FetchError
from haptic_glance.deep.device import choose_device
from haptic_glance.deep.modes import MODES, is_range, parse_range
from haptic_glance.deep.network import NETWORKS, SMALLEST, UNNORMALISED, WEIGHTS
from haptic_glance.deep.training import PRINTED, check_passes
from haptic_glance.deep.weights import available_weights, imagenet_state
from haptic_glance.disturb import imprint, picture

from .middle import middle_of
from .schema import Params
from .split import SPLITS
from .touches import sensor_arrays


class Trial(NamedTuple):
    """The settings of one training; its name is DATA.NETWORK.WEIGHTS.MODE.SPLIT.REPETITION.PASSES, with - for a colon.

    The name of a training with as many passes as printed ends with the repetition.
    """

    data: str
    network: str
    weights: str
    mode: str
    split: str
    repetition: int
    passes: str = PRINTED

    @property
    def name(self) -> str:
        known = self[:-1] if self.passes == PRINTED else self
        return ".".join(map(str, known)).replace(":", "-")

    @classmethod
    def parse(cls, name: str) -> Self:
        """The trial with this name."""
        data, network, weights, mode, split, repetition, *passes = name.split(".")
        return cls(data, network, weights, mode.replace("-", ":"), split, int(repetition), *passes)


class Plan(NamedTuple):
    """The trainings of a run.

    trials: all trainings. members: {split: {class: its objects}} that take part. pretrained: {network: which of its
    ImageNet weights are available}. notes: (columns of the row, one sentence) for everything that is left out.
    """

    trials: list[Trial]
    members: dict[str, dict[str, list[str]]]
    pretrained: dict[str, str | None]
    notes: list[tuple[dict, str]]


def check(settings: Params) -> None:
    """Raises ValueError, which names the setting and its possible values, for settings that cannot be run."""
    lists = {"weights": WEIGHTS, "splits": SPLITS} | dict.fromkeys(("networks", "uncontrolled"), tuple(NETWORKS))
    for key, known in lists.items():
        unknown = sorted(set(getattr(settings, key)) - set(known))
        if unknown or not (getattr(settings, key) or key == "uncontrolled"):
            raise ValueError(
                f"transfer.{key}: {', '.join(unknown) or 'none'} not known, choose from {', '.join(known)}"
            )
    for network, modes in settings.networks.items():
        _check_modes(network, modes)
    if min(max(settings.splits.values()), settings.touches - 1, settings.cells, *settings.coarse_cells) < 1:
        raise ValueError("transfer: of one split and of cells there must be 1 or more, of touches 2")
    check_passes(settings.passes, "transfer.passes")
    if min(settings.patience, settings.most_epochs) < 1:
        raise ValueError("transfer: patience and most_epochs must be 1 or more")
    if settings.size < SMALLEST:
        raise ValueError(f"transfer.size: {settings.size} is too small, networks see {SMALLEST} pixels a side or more")
    counts = settings.new_object_touches or [0]
    if min(counts) < 1 or max(counts) >= settings.touches:
        raise ValueError(f"transfer.new_object_touches: {settings.new_object_touches} must be 1 or more and less than "
                         f"transfer.touches ({settings.touches}), so that some are left to ask about")  # fmt: skip
    if choose_device(settings.device).type == "cuda" and "random_initial" in settings.weights:
        raise ValueError("transfer.weights: features of random_initial are too small for a card's half precision, "
                         "take transfer.device=cpu for it")  # fmt: skip
    imprint.check(settings.severities)
    picture.check(settings.hybrid_severities)
    for layers in settings.hybrid_middles:
        middle_of(layers)


def _check_modes(network: str, modes: Sequence[str]) -> None:
    """Raises ValueError for a mode that a network does not have; only mobilenet_v2 has ranges of layers."""
    ranges = [mode for mode in modes if is_range(mode) and network == "mobilenet_v2"]
    unknown = [mode for mode in modes if mode not in (*MODES, *ranges)]
    if unknown or not modes:
        known = f"{', '.join(MODES)}, or for mobilenet_v2 ranges of layers such as 18:139"
        raise ValueError(f"transfer.networks.{network}: {', '.join(unknown) or 'none'} not known, choose from {known}")
    for mode in ranges:
        parse_range(mode)


def plan(classes: Mapping[str, Sequence[str]], vertices: Mapping[str, int], settings: Params) -> Plan:
    """The Plan for classes {class: its objects}. vertices: {object: number of vertices that can be touched}.

    On the first data all weights and all modes of each network are trained, in every split. On the others, which are
    for comparing resolutions, only ImageNet's weights and no range of layers. A range of layers has no control, nor has
    a network that is `uncontrolled`. random_initial is for frozen networks that have a normalisation: training sets its
    statistics anew. There are no trials where fewer than two classes are left.
    """
    members, notes = _members(classes, vertices, settings.touches)
    if len(members["random"]) < 2:
        note = (
            f"two classes or more are needed, got {', '.join(members['random']) or 'none'}: add some to meshes.classes"
        )
        return Plan([], members, {}, [*notes, ({}, note)])
    found, left_out = fetch_weights(settings)
    splits = {split: count for split, count in settings.splits.items() if len(members[split]) > 1}
    if settings.splits.get("objects") and "objects" not in splits:
        left_out.append(({"split": "objects"}, "fewer than two classes have a second object: none is left out"))
    kinds = itertools.product(_kinds(settings, found), splits.items(), settings.passes)
    trials = [Trial(*kind, split, number, passes) for kind, (split, count), passes in kinds for number in range(count)]
    return Plan(trials, members, found, notes + left_out)


def main_data(settings: Params) -> str:
    """The data on which everything is measured: the imprints of the first, finest array."""
    return next(iter(sensor_arrays(settings)))


def fetch_weights(settings: Params) -> tuple[dict[str, str | None], list[tuple[dict, str]]]:
    """({network: which of its ImageNet weights are available}, notes on the others); fetches what is missing."""
    if "imagenet" not in settings.weights:
        return dict.fromkeys(settings.networks), []
    found, notes = {}, []
    for network in settings.networks:
        try:
            imagenet_state(network, settings.source)  # before the work starts, not in each worker
            found[network] = available_weights(network, settings.source)
        except FetchError as error:
            notes.append(({"method": network}, f"{network} left out, no weights: {error}"))
    return found, notes


def _kinds(settings, networks):
    """(data, network, weights, mode) of all trainings."""
    first = main_data(settings)
    for data, network, weights in itertools.product(sensor_arrays(settings), networks, settings.weights):
        for mode in settings.networks[network]:
            control, ranged = weights != "imagenet", is_range(mode)
            left_out = control and (ranged or network in settings.uncontrolled)
            left_out |= weights == "random_initial" and (mode != "frozen" or network in UNNORMALISED)
            if not left_out and (data == first or not (control or ranged)):
                yield data, network, weights, mode


def _members(classes, vertices, touches):
    """({split: {class: its objects}}, notes); an object with fewer vertices than touches cannot take part."""
    kept, notes = {}, []
    for name, objects in classes.items():
        small = [one for one in objects if vertices.get(one, 0) < touches]
        notes += [
            ({}, f"class {name}: {one} left out, {vertices.get(one, 0)} vertices can be touched, not {touches}")
            for one in small
        ]
        left = [one for one in objects if one not in small]
        if left:
            kept[name] = left
        else:
            notes.append(({}, f"class {name} left out: no object of it is left"))
    spare = {name: objects for name, objects in kept.items() if len(objects) > 1}
    notes += [
        ({"split": "objects"}, f"class {name} has one object alone: it cannot be left out")
        for name in kept
        if name not in spare
    ]
    return {"random": kept, "objects": spare}, notes
