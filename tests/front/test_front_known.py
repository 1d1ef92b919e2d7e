"""Answers by touch with a known truth: who learned what is asked knows it, and seconds are the sum of their parts."""

import numpy as np
import pytest

from haptic_glance.base.rng import rng
from stages.front.known import PARTS, Effort, Objects, known
from stages.front.senses import Felt
from stages.front.space import SPACE, choice_of

SHAPES = tuple(f"shape{k}" for k in range(7))
CLASSES = {"round": ("ball", "egg"), "flat": ("plate", "tray"), "long": ("rod", "stick")}
OBJECTS = Objects(SHAPES, CLASSES)
NAMES = [*SHAPES, *(name for names in CLASSES.values() for name in names)]
EFFORT = Effort(shapes=7, sixes=3, regions=2, folds=2)
CHOICE = choice_of({name: options[0] for name, options in SPACE.items()} | {"method": "random"})
SECONDS = {"simplifying": 1.0, "looking": 2.0, "surfaces": 0.5, "pressing": 0.25}


class Made:
    """Senses that feel made-up touches: a code of the object or class, and noise; places on a unit square."""

    def __init__(self, noise=0.1, asked=lambda code: code, spread=1.0):
        self.noise, self.asked, self.spread = noise, asked, spread

    def feel(self, name, choice):
        random = rng(0, name)
        label = next((label for label, names in CLASSES.items() if name in names), name)
        code = rng(1, label).normal(size=41)
        learned, asked = (
            part + self.noise * random.normal(size=(choice.points, 41)) for part in (code, self.asked(code))
        )
        places = np.c_[self.spread * random.random((choice.points, 2)), np.zeros(choice.points)]
        return Felt(learned, asked, places, 100, SECONDS)


def of(rows, split):
    return [row for row in rows if row["split"] == split]


def accuracy(rows, split):
    return np.mean([row["value"] for row in of(rows, split)])


def changed(**options):
    return choice_of({name: value or SPACE[name][0] for name, value in (CHOICE.columns | options).items()})


def test_what_feels_as_it_was_learned_is_known_and_there_is_a_row_an_object():
    rows = known(Made(), OBJECTS, CHOICE, EFFORT, 0)
    assert accuracy(rows, "regions") == accuracy(rows, "objects") == 1
    assert sorted(row["item"] for row in rows) == sorted(NAMES)
    assert {row["group"] for row in of(rows, "objects")} == set(CLASSES)


def test_learning_is_from_the_model_and_asking_of_the_object():
    rows = known(Made(asked=lambda code: -code), OBJECTS, CHOICE, EFFORT, 0)
    assert accuracy(rows, "regions") < 0.6 and accuracy(rows, "objects") < 0.6


def test_unseen_objects_are_never_learned():
    class Own(Made):
        def feel(self, name, choice):
            felt = super().feel(name, choice)
            code = 50 * rng(2, name).normal(size=41)  # which drowns the code of the class
            return Felt(felt.learned + code, felt.asked + code, felt.places, 100, SECONDS)

    rows = known(Own(), OBJECTS, CHOICE, EFFORT, 0)
    assert accuracy(rows, "regions") == 1 and accuracy(rows, "objects") < 0.9


def test_several_touches_vote():
    one, five = (known(Made(noise=4), OBJECTS, changed(touches=count), EFFORT, 0) for count in (1, 5))
    assert accuracy(five, "objects") > accuracy(one, "objects") + 0.05


def test_seconds_are_the_sum_of_their_parts_and_learning_stands_apart():
    for row in known(Made(), OBJECTS, changed(touches=3), EFFORT, 0):
        assert row["seconds"] == pytest.approx(sum(row[part] for part in PARTS))
        assert (row["simplifying"], row["looking"], row["pressing"]) == (1, 2, 0.5 + 3 * 0.25) and row["asking"] > 0
        assert row["training"] > 1 + 2 + 0.5 + 60 * 0.25


def test_the_same_seed_gives_the_same_answers():
    first, again, other = (
        [row["value"] for row in known(Made(noise=4), OBJECTS, CHOICE, EFFORT, seed)] for seed in (0, 0, 1)
    )
    assert first == again != other


@pytest.mark.parametrize(("made", "options"), [(Made(spread=0.1), {}), (Made(), {"points": 20, "touches": 6})])
def test_where_no_region_is_left_the_row_says_so(made, options):
    for row in of(known(made, OBJECTS, changed(**options), EFFORT, 0), "regions"):
        assert row["value"] is None and row["note"] == "too few touches in a region of it, or apart from it"
