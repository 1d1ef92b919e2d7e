"""Which trainings there are to run, and what has to be left out, with the reason."""

import itertools
from typing import NamedTuple

from stages.kit.fetch import FetchError
from stages.networks.device import choose
from stages.networks.layers import is_range, parse
from stages.networks.modes import MODES
from stages.networks.network import NETWORKS, START
from stages.networks.weights import had, imagenet_state

from . import disturbed, hybrid_damage
from .middle import middle_of
from .split import SPLITS
from .touches import arrays


class Trial(NamedTuple):
    """What one training is; its name is DATA.NETWORK.WEIGHTS.MODE.SPLIT.REPETITION, a range with - for its colon."""

    data: str
    network: str
    weights: str
    mode: str
    split: str
    repetition: int

    @property
    def name(self):
        return ".".join(map(str, self)).replace(":", "-")

    @classmethod
    def parse(cls, name):
        """The trial of a name."""
        data, network, weights, mode, split, repetition = name.split(".")
        return cls(data, network, weights, mode.replace("-", ":"), split, int(repetition))


class Plan(NamedTuple):
    """What a run does.

    trials: all trainings. members: {split: {class: its objects}} that take part. had: {network: which ImageNet weights
    it has}. notes: (what the row is about, one sentence) for all that is left out.
    """

    trials: list[Trial]
    members: dict[str, dict[str, list[str]]]
    had: dict[str, str]
    notes: list[tuple[dict, str]]


def check(settings):
    """Raises ValueError, naming the setting and what is known, for what cannot be run."""
    for key, known in (("weights", START), ("splits", SPLITS), ("networks", tuple(NETWORKS))):
        strange = sorted(set(getattr(settings, key)) - set(known))
        if strange or not getattr(settings, key):
            raise ValueError(f"transfer.{key}: {', '.join(strange) or 'none'} not known, choose of {', '.join(known)}")
    strange = sorted(mode for mode in settings.modes if mode not in MODES and not is_range(mode))
    if strange or not settings.modes:
        known = f"{', '.join(MODES)}, or ranges of mobilenet_v2's layers such as 18:139"
        raise ValueError(f"transfer.modes: {', '.join(strange) or 'none'} not known, choose of {known}")
    for mode in filter(is_range, settings.modes):
        parse(mode)
    if min(settings.repetitions, settings.coarse_repetitions, settings.cells, *settings.coarse_cells) < 1:
        raise ValueError("transfer: repetitions and cells, the coarse ones too, must be 1 or more")
    choose(settings.device)
    disturbed.check(settings.severities)
    hybrid_damage.check(settings.hybrid_severities)
    for layers in settings.hybrid_middles:
        middle_of(layers)


def plan(classes, vertices, settings):
    """The Plan for classes {class: its objects}. vertices: {object: how many of its vertices can be touched}.

    All kinds of weights and modes on the first data, in every split; on the others, which are there for the
    resolution, ImageNet's weights alone and no range of layers. A range of layers has no control. No trials where less
    than two classes are left.
    """
    members, notes = _members(classes, vertices, settings.touches)
    if len(members["random"]) < 2:
        note = (
            f"two classes or more are needed, got {', '.join(members['random']) or 'none'}: add some to classes.names"
        )
        return Plan([], members, {}, [*notes, ({}, note)])
    found, left_out = weights_of(settings)
    splits = [split for split in settings.splits if len(members[split]) > 1]
    if "objects" in settings.splits and "objects" not in splits:
        left_out.append(({"split": "objects"}, "less than two classes can spare an object: none is left out"))
    trials = []
    for kind in _kinds(settings, found):
        count = settings.repetitions if kind[0] == main_data(settings) else settings.coarse_repetitions
        trials += [Trial(*kind, split, number) for split in splits for number in range(count)]
    return Plan(trials, members, found, notes + left_out)


def main_data(settings):
    """The data that everything is measured on: the finest array's."""
    return next(iter(arrays(settings)))


def weights_of(settings):
    """({network: which ImageNet weights it had}, notes on those that cannot be fetched); fetches what is missing."""
    if "imagenet" not in settings.weights:
        return dict.fromkeys(settings.networks), []
    found, notes = {}, []
    for network in settings.networks:
        try:
            imagenet_state(network, settings.source)  # before the work starts, not in each worker
            found[network] = had(network, settings.source)
        except FetchError as error:
            notes.append(({"method": network}, f"{network} left out, no weights: {error}"))
    return found, notes


def _kinds(settings, networks):
    """(data, network, weights, mode) of all that is trained."""
    first = main_data(settings)
    for data, network, weights, mode in itertools.product(arrays(settings), networks, settings.weights, settings.modes):
        ranged = is_range(mode)
        extra = weights == "random" or ranged
        if (extra and data != first) or (ranged and (weights == "random" or network != "mobilenet_v2")):
            continue
        yield data, network, weights, mode


def _members(classes, vertices, touches):
    """({split: {class: its objects}}, notes); an object without vertices enough for its touches cannot take part."""
    kept, notes = {}, []
    for name, objects in classes.items():
        poor = [one for one in objects if vertices.get(one, 0) < touches]
        notes += [
            ({}, f"class {name}: {one} left out, {vertices.get(one, 0)} vertices can be touched, not {touches}")
            for one in poor
        ]
        left = [one for one in objects if one not in poor]
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
