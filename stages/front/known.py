"""How well a choice knows objects by touch: which of six shapes by an unseen region, and unseen objects' classes."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from sklearn import config_context
from threadpoolctl import threadpool_limits

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import classifier, draw_combinations, region_holdout
from haptic_glance.know.split import Split
from stages.kit.run import Rows
from stages.sensor_size.protocol import majority

from .objects import Objects
from .senses import Felt, Senses
from .space import WIDTH, Choice, settings_of

ATTEMPTS = 5  # draws of a region until touches apart from it are left to learn from
PARTS = ("simplifying", "looking", "pressing", "asking")  # of the seconds to know one object


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
        asked = {
            Split.REGIONS: list(_of_regions(senses, objects, choice, effort, seed)),
            Split.OBJECTS: list(_of_objects(senses, objects, choice, effort, seed)),
        }
    groups = {Split.REGIONS: dict.fromkeys(objects.shapes[: effort.shapes], "")}
    groups[Split.OBJECTS] = {name: label for label, names in objects.classes.items() for name in names}
    return [
        _row(name, group, split, senses.feel(name, choice), choice, answers)
        for split, answers in asked.items()
        for name, group in groups[split].items()
    ]


def _row(name, group, split, felt: Felt, choice, answers: list[Answers]):
    """The row of one object; its seconds are those from its mesh to its name, in order."""
    own = [one for one in answers if name in one.right]
    row = {"item": name, "group": group, "split": split, "metric": "accuracy", "value": None, "faces": felt.faces}
    row |= choice.columns
    if not own:
        return row | {"seconds": None, "note": "too few touches in a region of it, or apart from it"}
    seconds = {part: felt.seconds[part] for part in ("simplifying", "looking")}
    seconds["pressing"] = felt.seconds["surfaces"] + choice.touches * felt.seconds["pressing"]
    seconds["asking"] = float(np.mean([one.asking for one in own]))
    learned = felt.seconds["simplifying"] + felt.seconds["looking"] + felt.seconds["surfaces"]
    learned += len(felt.learned) * felt.seconds["pressing"]
    training = float(np.mean([one.learning / len(one.right) for one in own])) + learned
    value = float(np.mean([one.right[name] for one in own]))
    return row | seconds | {"training": training, "value": value, "seconds": sum(seconds.values()), "note": None}


def _of_regions(senses, objects, choice, effort, seed) -> Iterator[Answers]:
    """Each set of six, with a region of each shape held out, where touches apart from it are left."""
    for number, names in enumerate(objects.sixes(effort.shapes, effort.sixes, seed)):
        felt = [senses.feel(name, choice) for name in names]
        count = min(len(one.places) for one in felt)
        truth = np.repeat(np.arange(len(names)), count)
        learned, asked, places = (
            np.concatenate([getattr(one, part)[:count] for one in felt]) for part in ("learned", "asked", "places")
        )
        for repetition in range(effort.regions):
            random = rng(seed, f"regions {number} {repetition}")
            draws = (region_holdout(truth, places, WIDTH, int(random.integers(2**31))) for _ in range(ATTEMPTS))
            train, test = next((found for found in draws if found is not None), ([], []))
            if len(test) and np.bincount(truth[test]).min() >= choice.touches:
                yield _ask(choice, learned[train], truth[train], asked[test], truth[test], names, names, random)


def _of_objects(senses, objects, choice, effort, seed) -> Iterator[Answers]:
    """The classes, with one object of each left out: another one of each class in turn, in orders drawn at random."""
    labels = list(objects.classes)
    felt = {name: senses.feel(name, choice) for names in objects.classes.values() for name in names}
    turns = min(map(len, objects.classes.values()))
    for fold in range(effort.folds):
        random = rng(seed, f"objects {fold // turns}")
        orders = [random.permutation(objects.classes[label]).tolist() for label in labels]
        left = [order[fold % turns] for order in orders]
        rest = [(k, felt[name]) for k, order in enumerate(orders) for name in order if name != left[k]]
        learned = np.concatenate([one.learned for _, one in rest])
        truth = np.repeat([k for k, _ in rest], [len(one.learned) for _, one in rest])
        asked = np.concatenate([felt[name].asked for name in left])
        owners = np.repeat(np.arange(len(left)), [len(felt[name].asked) for name in left])
        random = rng(seed, f"objects {fold}")
        yield _ask(choice, learned, truth, asked, owners, left, labels, random)


def _ask(choice, learned, truth, asked, owners, names, answers, random) -> Answers:
    """Learns samples (k, 41) of truth (k,), and asks about samples of owners: ids of `names` and of `answers`.

    Each touch is asked about once with `choice.touches` - 1 others of its object; what most of them say is the answer.
    """
    model = classifier(settings_of(choice).classification.classifiers[0], int(random.integers(2**31)))
    with Stopwatch() as learning:
        model.fit(learned, truth)
    together = draw_combinations(owners, choice.touches, random)
    with Stopwatch() as asking:
        said = majority(model.predict(asked)[together].ravel(), choice.touches)
    right = {name: float((said[owners == k] == k).mean()) for k, name in enumerate(names)}
    return Answers(right, learning.seconds, choice.touches * asking.seconds / len(asked))
