"""How well a choice knows objects by touch, the objects of search and confirmation, and the rows of the front.

A choice is tested on which of six shapes has an unseen region, and on the classes of unseen objects. The objects that
confirm the front are hidden from the search.
"""

import zlib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from sklearn import config_context
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import object_files
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import classifier, draw_combinations, region_holdout
from haptic_glance.know.split import Split
from stages.engine.rows import SUFFIX, write_rows
from stages.engine.run import Rows
from stages.meshes.collect import read_classes
from stages.sensor_size.protocol import majority

from .senses import Felt, Senses
from .space import WIDTH, Choice, settings_of

SIZES = ("medium", "small")  # of five basic shapes, which are equal to the large one once they are scaled
SIX = 6  # objects of one question: who of these six is it (T4.2.4)


@dataclass(frozen=True)
class Objects:
    """Shapes to tell apart, and classes {class: objects} whose unseen objects are to be named."""

    shapes: tuple[str, ...]
    classes: Mapping[str, tuple[str, ...]]

    def sixes(self, shapes: int, count: int, seed: int) -> list[list[str]]:
        """`count` sets of six of the first `shapes`, drawn so that each of these is in as many of them, or in one more.

        ValueError for fewer than six.
        """
        shapes_used, uses, sets = self.shapes[:shapes], Counter(), []
        if len(shapes_used) < SIX:
            raise ValueError(f"{len(shapes_used)} shapes to tell apart are too few: {SIX} are needed")
        for number in range(count):
            order = rng(seed, f"six {number}").permutation(shapes_used).tolist()
            sets.append(sorted(sorted(order, key=lambda name: uses[name])[:SIX]))  # of equals in the order drawn
            uses.update(sets[-1])
        return sets


def halves(shapes: Iterable[str], classes: Mapping[str, Sequence[str]], seed: int) -> tuple[Objects, Objects]:
    """(objects of the search, objects of the confirmation), which share neither a shape nor a class.

    A shape or class is of the search by its place in the order of a checksum of the seed and its name.
    """
    first, second = (
        Objects(tuple(part), {name: tuple(classes[name]) for name in sorted(groups)})
        for part, groups in zip(_halved(shapes, seed), _halved(classes, seed), strict=True)
    )
    return first, second


def _halved(names, seed):
    order = sorted(names, key=lambda name: (zlib.crc32(f"{seed} {name}".encode()), name))
    return order[: len(order) // 2], order[len(order) // 2 :]


def shapes_of(names: Iterable[str]) -> list[str]:
    """The names without those that are another size of a shape among them."""
    distinct = set(names)
    return sorted(
        name
        for name in distinct
        if not any(name.endswith(size) and f"{name.removesuffix(size)}large" in distinct for size in SIZES)
    )


def read_objects(data: Path, shapes: str, classes: str) -> tuple[list[str], dict[str, list[str]], dict[str, Path]]:
    """(shapes of one data set, {class: objects} of another, {object: its mesh} of both), from data/SET/meshes.

    ValueError where meshes are not there, where an object is of both sets (it could be searched on and confirm), and
    for a class of one object.
    """
    files: dict[str, Path] = {}
    for dataset in (shapes, classes):
        folder = data / dataset / "meshes"
        names = object_files(folder)
        if not names:
            remedy = f"`python -m stages.compose 'sets=[{shapes},{classes}]'`, then `dvc repro meshes@{dataset}`"
            raise ValueError(f"{folder} holds no meshes: {remedy}")
        if shared := sorted(files.keys() & set(names)):
            raise ValueError(f"{', '.join(shared)}: objects of both {shapes} and {classes}; name other --classes")
        files |= {name: folder / f"{name}.npz" for name in names}
    groups = read_classes(data / classes / "meshes")
    if small_classes := [name for name, members in groups.items() if len(members) < 2]:
        raise ValueError(f"{classes}: of class {', '.join(small_classes)} no object can be held out: two are needed")
    return shapes_of(object_files(data / shapes / "meshes")), groups, files


ATTEMPTS = 5  # draws of a region until touches apart from it are left to learn from


@dataclass(frozen=True)
class Effort:
    """How much is asked of a choice. shapes: how many of those there are, in sets of six; each drawn split is one."""

    shapes: int
    sixes: int
    regions: int  # splits of each set of six
    folds: int  # times that one object of each class is left out


@dataclass(frozen=True)
class Answers:
    """One split: the share of right answers of each object, and the seconds of learning and of one answer."""

    right: dict[str, float]
    learning: float
    asking: float


def known(senses: Senses, objects: Objects, choice: Choice, effort: Effort, seed: int) -> Rows:
    """A row for each object: its accuracy, the seconds to know it with their parts, and those of training, apart.

    Split `regions`: it is one of six shapes that were learned elsewhere on their surface. Split `objects`: one of the
    classes, of which it was left out. Objects that no split could ask about have a row without value, which says so.
    """
    with threadpool_limits(1), config_context(assume_finite=True, skip_parameter_validation=True):
        by_split = {
            Split.REGIONS: list(_of_regions(senses, objects, choice, effort, seed)),
            Split.OBJECTS: list(_of_objects(senses, objects, choice, effort, seed)),
        }
    groups = {Split.REGIONS: dict.fromkeys(objects.shapes[: effort.shapes], "")}
    groups[Split.OBJECTS] = {name: label for label, names in objects.classes.items() for name in names}
    return [
        _row(name, group, split, senses.feel(name, choice), choice, answers)
        for split, answers in by_split.items()
        for name, group in groups[split].items()
    ]


def _row(name, group, split, felt: Felt, choice, answers: list[Answers]):
    """The row of one object; its seconds are those from its mesh to its name, in order."""
    relevant = [answer for answer in answers if name in answer.right]
    row = {"item": name, "group": group, "split": split, "metric": "accuracy", "value": None, "faces": felt.faces}
    row |= choice.columns
    if not relevant:
        return row | {"seconds": None, "note": "too few touches in a region of it, or apart from it"}
    seconds = {part: felt.seconds[part] for part in ("simplifying", "looking")}
    seconds["pressing"] = felt.seconds["surfaces"] + choice.touches * felt.seconds["pressing"]
    seconds["asking"] = float(np.mean([answer.asking for answer in relevant]))
    learned = felt.seconds["simplifying"] + felt.seconds["looking"] + felt.seconds["surfaces"]
    learned += len(felt.learned) * felt.seconds["pressing"]
    training = float(np.mean([answer.learning / len(answer.right) for answer in relevant])) + learned
    value = float(np.mean([answer.right[name] for answer in relevant]))
    return row | seconds | {"training": training, "value": value, "seconds": sum(seconds.values()), "note": None}


def _of_regions(senses, objects, choice, effort, seed) -> Iterator[Answers]:
    """Each set of six, with a region of each shape held out, where touches apart from it are left."""
    for number, names in enumerate(objects.sixes(effort.shapes, effort.sixes, seed)):
        felt = [senses.feel(name, choice) for name in names]
        count = min(len(item.places) for item in felt)
        truth = np.repeat(np.arange(len(names)), count)
        learned, queries, places = (
            np.concatenate([getattr(item, part)[:count] for item in felt]) for part in ("learned", "asked", "places")
        )
        for repetition in range(effort.regions):
            random = rng(seed, f"regions {number} {repetition}")
            draws = (region_holdout(truth, places, WIDTH, int(random.integers(2**31))) for _ in range(ATTEMPTS))
            train, test = next((split for split in draws if split is not None), ([], []))
            if len(test) and np.bincount(truth[test]).min() >= choice.touches:
                yield _ask(choice, learned[train], truth[train], queries[test], truth[test], names, names, random)


def _of_objects(senses, objects, choice, effort, seed) -> Iterator[Answers]:
    """The classes, with one object of each left out: another one of each class in turn, in orders drawn at random."""
    labels = list(objects.classes)
    felt = {name: senses.feel(name, choice) for names in objects.classes.values() for name in names}
    turns = min(map(len, objects.classes.values()))
    for fold in range(effort.folds):
        random = rng(seed, f"objects {fold // turns}")
        orders = [random.permutation(objects.classes[label]).tolist() for label in labels]
        held_out = [order[fold % turns] for order in orders]
        learned_items = [(k, felt[name]) for k, order in enumerate(orders) for name in order if name != held_out[k]]
        learned = np.concatenate([item.learned for _, item in learned_items])
        truth = np.repeat([k for k, _ in learned_items], [len(item.learned) for _, item in learned_items])
        queries = np.concatenate([felt[name].asked for name in held_out])
        owners = np.repeat(np.arange(len(held_out)), [len(felt[name].asked) for name in held_out])
        random = rng(seed, f"objects {fold}")
        yield _ask(choice, learned, truth, queries, owners, held_out, labels, random)


def _ask(choice, learned, truth, queries, owners, names, answers, random) -> Answers:
    """Learns samples (k, 41) of truth (k,), and asks about samples of owners: ids of `names` and of `answers`.

    Each touch is asked about once with `choice.touches` - 1 others of its object; what most of them say is the answer.
    """
    model = classifier(settings_of(choice).classification.classifiers[0], int(random.integers(2**31)))
    with Stopwatch() as learning:
        model.fit(learned, truth)
    together = draw_combinations(owners, choice.touches, random)
    with Stopwatch() as asking:
        predicted = majority(model.predict(queries)[together].ravel(), choice.touches)
    right = {name: float((predicted[owners == k] == k).mean()) for k, name in enumerate(names)}
    return Answers(right, learning.seconds, choice.touches * asking.seconds / len(queries))


COLUMNS = {
    "rung": "a name of stages.front.search.RUNGS, `confirmation` or `one_choice`",
    "number": "of the choice, in the order in which it was first asked about",
    "role": "of a choice that is confirmed: smallest (within two points of the best), or default (the project's own)",
    "viewpoints": "set of viewpoints; empty where the method looks at no picture",
    "image_rows": "rows of an image",
    "points": "places that are looked for and learned, of each object",
    "cells": "sensels a side of the array, which is as wide whatever their number",
    "level": "faces that the model of an object was to have: a number, or 100% for all",
    "faces": "faces that it has",
    "touches": "touches of one answer",
    "classifier": "a name of haptic_glance.know.CLASSIFIERS",
    "simplifying": "seconds, the first part of the column `seconds`",
    "looking": "seconds: pictures, maps, saliency and the choice of the places",
    "pressing": "seconds: the array on the object, once for each touch, and the features",
    "asking": "seconds of the classifier's answer",
    "training": "seconds of learning the object, not part of `seconds`",
}
STAGE = "front"


def write(measurements: Path, sets: tuple[str, str], rows: Rows, seed: int) -> list[Path]:
    """Writes the rows of shapes and of classes below the names of their data sets, and returns the files.

    Those of an earlier search go, whatever its sets: rows of two searches do not belong together.
    """
    paths = []
    for older in measurements.glob(f"*/{STAGE}{SUFFIX}"):
        older.unlink()
    for dataset, split in zip(sets, (Split.REGIONS, Split.OBJECTS), strict=True):
        paths.append(measurements / dataset / f"{STAGE}{SUFFIX}")
        write_rows(paths[-1], _of(rows, split), COLUMNS, dataset, seed)
    return paths


def _of(rows: Rows, split: Split) -> Iterable[dict]:
    return (row for row in rows if row["split"] == split)
