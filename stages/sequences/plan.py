"""The trials of a run, and what is left out with the reason."""

import re
from pathlib import Path
from typing import NamedTuple

from haptic_glance.know.split import Split
from stages.contours import read_sequences

from .dataset import count_sequences, is_divisible
from .networks import SHORTEST, SMALLEST
from .schema import Params
from .trial import KINDS, Trial

MIN_SEQUENCES = 5  # per object and strategy: a split of 80:20 then still tests one


class Plan(NamedTuple):
    """The trials of a run, {class: objects} that take part, and one note for each thing that is left out."""

    trials: list[Trial]
    members: dict[str, list[str]]
    notes: list[str]


def plan(classes: dict[str, list[str]], folder: Path, settings: Params) -> Plan:
    """The Plan for classes {class: objects} with their sequences in `folder` (data/SET/contours).

    Every strategy is tested in both splits with all classifiers. Fewer frames and smaller imprints are tested on one
    strategy, with objects held out where every class has two or more. There are no trials with fewer than two classes.
    """
    members, notes = _members(classes, folder)
    if len(members) < 2:
        return Plan([], members, [*notes, f"two classes with sequences are needed, got {len(members)}"])
    strategies, left_out = _strategies(members, folder)
    notes += left_out
    if not strategies:
        return Plan([], members, [*notes, "no strategy has sequences of every object"])
    first = next(iter(members.values()))[0]
    shape = read_sequences(folder / f"{first}.npz")[strategies[0]].images.shape[1:]
    folds = min(len(objects) for objects in members.values())
    if folds < 2:
        notes.append("objects are not held out: every class needs two or more")
    object_rounds = [(Split.OBJECTS, number) for number in range(folds * settings.trainings)] if folds > 1 else []
    rounds = [(Split.RANDOM, number) for number in range(settings.repetitions)] + object_rounds
    full_size = _possible(f"{shape[0]}x{shape[1]}", shape, KINDS, notes)
    trials = [
        Trial(strategy, *each, kind, size) for strategy in strategies for each in rounds for kind, size in full_size
    ]
    if settings.smaller_strategy in strategies:
        for kind, sizes in (("networks", settings.smaller_networks), ("conventional", settings.smaller)):
            reduced = [pair for size in sizes for pair in _possible(size, shape, [kind], notes)]
            trials += [
                Trial(settings.smaller_strategy, *each, *pair) for pair in reduced for each in object_rounds or rounds
            ]
    return Plan(list(dict.fromkeys(trials)), members, notes)


def _members(classes, folder):
    """({class: its objects that have sequences}, notes)."""
    members, notes = {}, []
    for name, objects in classes.items():
        available = [one for one in objects if (folder / f"{one}.npz").exists()]
        missing = [one for one in objects if one not in available]
        if missing:
            notes.append(f"class {name}: no sequences of {', '.join(missing)}")
        if available:
            members[name] = available
    return members, notes


def _strategies(members, folder):
    """(strategies with enough sequences of every object, notes on the others)."""
    counts = {one: count_sequences(folder / f"{one}.npz") for objects in members.values() for one in objects}
    usable, notes = [], []
    for strategy in dict.fromkeys(name for by_strategy in counts.values() for name in by_strategy):
        too_few = [one for one, by_strategy in counts.items() if by_strategy.get(strategy, 0) < MIN_SEQUENCES]
        if too_few:
            notes.append(f"{strategy} left out: fewer than {MIN_SEQUENCES} sequences of {', '.join(too_few)}")
        else:
            usable.append(strategy)
    return usable, notes


def _possible(size, shape, kinds, notes):
    """[(kind, size)] of the kinds that accept sequences of this size; appends to the notes why others do not."""
    match = re.fullmatch(r"(\d+)x(\d+)", size)
    if match is None:
        raise ValueError(f"sequences.smaller: {size!r} is not of the form FRAMESxCELLS, such as 13x16")
    frames, cells = map(int, match.groups())
    available, rows, columns = shape
    if not 2 <= frames <= available or cells < 4 or not is_divisible(cells, rows, columns):
        notes.append(f"size {size} left out: the sequences have {available} frames of {rows} x {columns} cells")
        return []
    small = frames < SHORTEST or cells < SMALLEST
    if small and "networks" in kinds:
        notes.append(f"networks left out at {size}: they need {SHORTEST} frames of {SMALLEST} x {SMALLEST} cells")
    return [(kind, size) for kind in kinds if kind != "networks" or not small]
