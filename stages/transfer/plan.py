"""The plan of trainings (networks, modes, splits and tables), and the metrics of a run.

The plan names the trainings that are left out, with the reasons. A division is at random, as in the thesis, or by
objects that are left out. The shared middle of two networks has the layer numbers of Matlab and torchvision (T5.5).
"""

import itertools
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import NamedTuple, Self

import numpy as np

from haptic_glance.base.fetch import FetchError
from haptic_glance.deep.device import choose_device, precision
from haptic_glance.deep.modes import MODES, frozen_modules, is_range, parse_range
from haptic_glance.deep.network import SMALLEST, UNNORMALISED, build
from haptic_glance.deep.training import PASSES, PRINTED, check_passes
from haptic_glance.deep.weights import available_weights, imagenet_state
from stages.engine.statistics import Split, interval_tree, stratified_split

from . import Params
from .imprint_images import sensor_arrays

PRINTED_RATE = "printed_rate"
# Learning rates of T table 5.4. T table 5.3 has one for all networks and modes.
PRINTED_RATES = {
    "frozen": dict.fromkeys(("alexnet", "googlenet", "vgg16", "resnet50", "mobilenet_v2"), 1e-4),
    "finetuned": {"alexnet": 2e-4, "googlenet": 5e-3, "vgg16": 5e-4, "resnet50": 1e-4, "mobilenet_v2": 5e-4},
}
PRINTED_COARSE_RATE = 1e-5


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
        parts = self[:-1] if self.passes == PRINTED else self
        return ".".join(map(str, parts)).replace(":", "-")

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
    """Raises ValueError, which names the setting, for settings that cannot be run."""
    for key in ("networks", "weights", "splits"):
        if not getattr(settings, key):
            raise ValueError(f"transfer.{key} must name at least one")
    for network, modes in settings.networks.items():
        _check_modes(network, modes)
    if min(max(settings.splits.values()), settings.touches - 1, settings.cells, *settings.coarse_cells) < 1:
        raise ValueError("transfer: of one split and of cells there must be 1 or more, of touches 2")
    check_passes(settings.passes, "transfer.passes", (*PASSES, PRINTED_RATE))
    check_passes([settings.hybrid_passes], "transfer.hybrid_passes")
    if min(settings.patience, settings.most_epochs) < 1:
        raise ValueError("transfer: patience and most_epochs must be 1 or more")
    for name, size in (("size", settings.size), ("hybrid_size", settings.hybrid_size)):
        if size < SMALLEST:
            raise ValueError(f"transfer.{name}: {size} is too small, networks see {SMALLEST} pixels a side or more")
    counts = settings.new_object_touches or [0]
    if min(counts) < 1 or max(counts) >= settings.touches:
        raise ValueError(f"transfer.new_object_touches: {settings.new_object_touches} must be 1 or more and less than "
                         f"transfer.touches ({settings.touches}), so that some are left to ask about")  # fmt: skip
    choose_device(settings.device)  # raises where there is no card
    for layers in settings.hybrid_middles:
        middle_of(layers)


def _check_modes(network: str, modes: Sequence[str]) -> None:
    """Raises ValueError for a mode that a network does not have; only mobilenet_v2 has ranges of layers."""
    ranges = [mode for mode in modes if is_range(mode) and network == "mobilenet_v2"]
    unknown = [mode for mode in modes if mode not in (*MODES, *ranges)]
    if unknown or not modes:
        options = f"{', '.join(MODES)}, or for mobilenet_v2 ranges of layers such as 18:139"
        raise ValueError(
            f"transfer.networks.{network}: {', '.join(unknown) or 'none'} not known, choose from {options}"
        )
    for mode in ranges:
        parse_range(mode)


def plan(classes: Mapping[str, Sequence[str]], vertices: Mapping[str, int], settings: Params) -> Plan:
    """The Plan for classes {class: its objects}. vertices: {object: number of vertices that can be touched}.

    On the first data all weights and all modes of each network are trained, in every split. On the others, which are
    for comparing resolutions, only ImageNet's weights and no range of layers. A range of layers has no control, nor has
    a network that is `uncontrolled`. random_initial is for frozen networks that have a normalisation: training sets its
    statistics anew. It is left out on a card, whose half precision rounds features below 1e-8 to nothing. Controls and
    ranges of layers have no printed rate. There are no trials where fewer than two classes are left.
    """
    members, notes = _members(classes, vertices, settings.touches)
    if len(members["random"]) < 2:
        note = (
            f"two classes or more are needed, got {', '.join(members['random']) or 'none'}: add some to meshes.classes"
        )
        return Plan([], members, {}, [*notes, ({}, note)])
    pretrained, left_out = fetch_weights(settings)
    splits = {split: count for split, count in settings.splits.items() if len(members[split]) > 1}
    if settings.splits.get("objects") and "objects" not in splits:
        left_out.append(({"split": "objects"}, "fewer than two classes have a second object: none is left out"))
    weights = list(settings.weights)
    if "random_initial" in weights and choose_device(settings.device).type == "cuda":
        weights.remove("random_initial")
        note = "left out on a card, whose half precision is too coarse for its features: take transfer.device=cpu"
        left_out.append(({"weights": "random_initial"}, note))
    kinds = itertools.product(_kinds(settings, pretrained, weights), splits.items(), settings.passes)
    trials = [Trial(*kind, split, number, passes) for kind, (split, count), passes in kinds for number in range(count)]
    trials = [trial for trial in trials if trial.passes != PRINTED_RATE or printed_rate(trial, settings)]
    return Plan(trials, members, pretrained, notes + left_out)


def main_data(settings: Params) -> str:
    """The data on which everything is measured: the imprints of the first, finest array."""
    return next(iter(sensor_arrays(settings)))


def printed_rate(trial: Trial, settings: Params) -> float | None:
    """The learning rate that T table 5.4 prints for the finest array, T table 5.3 for the others; None without one."""
    rate = PRINTED_RATES.get(trial.mode, {}).get(trial.network) if trial.weights == "imagenet" else None
    return rate and (rate if trial.data == main_data(settings) else PRINTED_COARSE_RATE)


def fetch_weights(settings: Params) -> tuple[dict[str, str | None], list[tuple[dict, str]]]:
    """({network: which of its ImageNet weights are available}, notes on the others); fetches what is missing."""
    if "imagenet" not in settings.weights:
        return dict.fromkeys(settings.networks), []
    pretrained, notes = {}, []
    for network in settings.networks:
        try:
            imagenet_state(network, settings.source)  # before the work starts, not in each worker
            pretrained[network] = available_weights(network, settings.source)
        except FetchError as error:
            notes.append(({"method": network}, f"{network} left out, no weights: {error}"))
    return pretrained, notes


def _kinds(settings, networks, starts):
    """(data, network, weights, mode) of all trainings."""
    first = main_data(settings)
    for data, network, weights in itertools.product(sensor_arrays(settings), networks, starts):
        for mode in settings.networks[network]:
            control, ranged = weights != "imagenet", is_range(mode)
            left_out = control and (ranged or network in settings.uncontrolled)
            left_out |= weights == "random_initial" and (mode != "frozen" or network in UNNORMALISED)
            if not left_out and (data == first or not (control or ranged)):
                yield data, network, weights, mode


def _members(classes, vertices, touches):
    """({split: {class: its objects}}, notes); an object with fewer vertices than touches cannot take part."""
    members, notes = {}, []
    for name, objects in classes.items():
        small = [item for item in objects if vertices.get(item, 0) < touches]
        notes += [
            ({}, f"class {name}: {item} left out, {vertices.get(item, 0)} vertices can be touched, not {touches}")
            for item in small
        ]
        usable = [item for item in objects if item not in small]
        if usable:
            members[name] = usable
        else:
            notes.append(({}, f"class {name} left out: no object of it is left"))
    spare = {name: objects for name, objects in members.items() if len(objects) > 1}
    notes += [
        ({"split": "objects"}, f"class {name} has one object alone: it cannot be left out")
        for name in members
        if name not in spare
    ]
    return {"random": members, "objects": spare}, notes


SPLITS = ("random", "objects")


def by_touches(objects: np.ndarray, train_share: float, validation_share: float, rng: np.random.Generator) -> Split:
    """The Split with a share of every object's touches for training, and the rest for testing.

    objects: (k,) i8, the object of each touch; validation_share: of the training touches. The thesis splits touches at
    random, 75 % to 25 % (T5.1.3). Touches of one object, even neighbouring ones, are then on both sides, so the
    accuracy is that on known objects, not on unseen ones of the same class.
    """
    train, test = stratified_split(objects, train_share, rng)
    validation, _ = stratified_split(objects[train], validation_share, rng)
    return Split(train, train[validation], test)


def by_objects(
    labels: np.ndarray, ranks: np.ndarray, number: int, validation_share: float, rng: np.random.Generator
) -> Split:
    """The Split with one object of each class for testing, and the others for training.

    labels, ranks: (k,) i8, the class of each touch and the index of its object in the class. The test object has rank
    `number` modulo the number of objects. The next object of every class is for validation, so that the learning rate,
    too, is chosen on unseen objects. Where a class has only two objects, validation is a share of the training touches.
    Raises ValueError for a class with one object.
    """
    counts = np.array([len(np.unique(ranks[labels == label])) for label in range(labels.max() + 1)])
    if counts.min() < 2:
        raise ValueError(f"class {counts.argmin()} has one object alone: it cannot be left out")
    turn = (ranks - number) % counts[labels]  # 0: test, 1: validation
    train, test = np.flatnonzero(turn != 0), np.flatnonzero(turn == 0)
    if counts.min() > 2:
        return Split(train, np.flatnonzero(turn == 1), test)
    validation, _ = stratified_split(labels[train], validation_share, rng)
    return Split(train, train[validation], test)


def middle_of(layers: str) -> tuple[int, int]:
    """(start, stop) of the parts of torchvision's `features` that a range of Matlab's layers such as `18:139` covers.

    Raises ValueError for a range that divides a part, or that leaves none before or after it: networks cannot be
    stitched there.
    """
    network = build("mobilenet_v2", 2, "random", 0)
    covered = set(frozen_modules(layers, network))
    parts = sorted({int(name.split(".")[1]) for name in covered})
    start, stop = (parts[0], parts[-1] + 1) if parts else (0, 0)
    whole = {
        name
        for name, module in network.named_modules()
        if name.startswith("convolutions.") and start <= int(name.split(".")[1]) < stop
        if any(True for _ in module.parameters(recurse=False))
    }
    if covered != whole or not 0 < start < stop < len(network.convolutions):
        raise ValueError(
            f"layers {layers} are not whole blocks of mobilenet_v2 with layers on both sides, as 18:139 are"
        )
    return start, stop


def seen(settings: Params) -> dict:
    """The columns of what a network saw and computed in."""
    numbers = precision(choose_device(settings.device))
    return {"size": settings.size, "touches": settings.touches, "precision": numbers}


def trial_row(row: dict, pretrained: Mapping[str, str | None], settings: Params) -> dict:
    """A row with the columns of its trial instead of the trial's name. pretrained: as in Plan."""
    trial = Trial.parse(row["trial"])
    columns: dict = {"data": trial.data, "method": trial.network, "weights": trial.weights}
    columns["pretrained"] = pretrained[trial.network] if trial.weights == "imagenet" else None
    columns |= {"mode": trial.mode, "split": trial.split, "repetition": trial.repetition, "passes": trial.passes}
    columns |= seen(settings)
    return columns | {key: value for key, value in row.items() if key != "trial"}


def summary(rows: list[dict], seed: int) -> dict[str, dict]:
    """{data: {split: {network: {MODE_WEIGHTS: {mean, low, high}}}}} of the accuracy, and the chance of each split.

    The key of trainings in another way than as printed ends with their passes.
    """
    values, tree = defaultdict(list), {}
    for row in rows:
        if row["metric"] == "accuracy" and not row.get("note"):
            passes = row.get("passes") or PRINTED
            end = f"_{passes}" if passes != PRINTED else ""
            key = row["data"], row["split"], row["method"], f"{row['mode']}_{row['weights']}{end}"
            values[key].append(row["value"])
        if row["metric"] == "chance":
            tree.setdefault("chance", {})[row["split"]] = round(row["value"], 6)
    return tree | interval_tree(values, seed)
