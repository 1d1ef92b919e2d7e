"""Which trials there are to run, and what has to be left out, with the reason."""

import re
from typing import NamedTuple

from stages.contours import read_sequences

from .dataset import counts_in, divides
from .networks import SHORTEST, SMALLEST
from .trial import KINDS, Trial

FEWEST = 5  # sequences a class and strategy: a split of 80:20 then still holds one out


class Plan(NamedTuple):
    """What a run does: the trials, {class: objects} that take part, and one sentence for all that is left out."""

    trials: list[Trial]
    members: dict[str, list[str]]
    notes: list[str]


def plan(classes, folder, settings):
    """The Plan for classes {class: objects} with their sequences in `folder` (data/contours).

    Every strategy is tried in both splits with all classifiers; then fewer frames and smaller imprints on one strategy,
    with unseen objects where every class has two or more. No trials where less than two classes are left.
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
        notes.append("no class can spare an object: each needs two or more, so objects are not left out")
    apart = [("objects", number) for number in range(folds)] if folds > 1 else []
    rounds = [("sequences", number) for number in range(settings.repetitions)] + apart
    whole = _possible(f"{shape[0]}x{shape[1]}", shape, KINDS, notes)
    found = [Trial(one, *each, kind, size) for one in strategies for each in rounds for kind, size in whole]
    if settings.smaller_strategy in strategies:
        for kind, sizes in (("networks", settings.smaller_networks), ("conventional", settings.smaller)):
            less = [pair for size in sizes for pair in _possible(size, shape, [kind], notes)]
            found += [Trial(settings.smaller_strategy, *each, *pair) for pair in less for each in apart or rounds]
    return Plan(list(dict.fromkeys(found)), members, notes)


def _members(classes, folder):
    """({class: its objects that have sequences}, notes)."""
    found, notes = {}, []
    for name, objects in classes.items():
        there = [one for one in objects if (folder / f"{one}.npz").exists()]
        missing = [one for one in objects if one not in there]
        if missing:
            notes.append(f"class {name}: no sequences of {', '.join(missing)}")
        if there:
            found[name] = there
    return found, notes


def _strategies(members, folder):
    """(strategies with enough sequences of every object, notes on the others)."""
    counts = {one: counts_in(folder / f"{one}.npz") for objects in members.values() for one in objects}
    known, notes = list(dict.fromkeys(name for own in counts.values() for name in own)), []
    for strategy in list(known):
        poor = [one for one, own in counts.items() if own.get(strategy, 0) < FEWEST]
        if poor:
            known.remove(strategy)
            notes.append(f"{strategy} left out: fewer than {FEWEST} sequences of {', '.join(poor)}")
    return known, notes


def _possible(size, shape, kinds, notes):
    """[(kind, size)] of those kinds that can take sequences of this size; adds why the others cannot to the notes."""
    match = re.fullmatch(r"(\d+)x(\d+)", size)
    if match is None:
        raise ValueError(f"sequences.smaller: {size!r} is no FRAMESxCELLS, such as 13x16")
    frames, cells = map(int, match.groups())
    there, rows, columns = shape
    if not 2 <= frames <= there or cells < 4 or not divides(cells, rows, columns):
        notes.append(f"size {size} left out: the sequences have {there} frames of {rows} x {columns} cells")
        return []
    small = frames < SHORTEST or cells < SMALLEST
    if small and "networks" in kinds:
        notes.append(f"networks left out at {size}: they need {SHORTEST} frames of {SMALLEST} x {SMALLEST} cells")
    return [(kind, size) for kind in kinds if kind != "networks" or not small]
