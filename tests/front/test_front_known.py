"""Answers by touch with a known truth, and the objects of the search and of its confirmation, which are apart."""

import numpy as np
import pytest

from haptic_glance.base.files import write_mesh, write_text
from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh
from stages.front.known import Effort, Objects, halves, known, read_objects, shapes_of
from stages.front.senses import Felt
from stages.front.space import SPACE, choice_of

SHAPES = tuple(f"shape{k}" for k in range(7))
CLASSES = {"round": ("ball", "egg"), "flat": ("plate", "tray"), "long": ("rod", "stick")}
OBJECTS = Objects(SHAPES, CLASSES)
EFFORT = Effort(shapes=7, sixes=3, regions=2, folds=2)
SECONDS = {"simplifying": 1.0, "looking": 2.0, "surfaces": 0.5, "pressing": 0.25}


class Made:
    """Senses that feel made-up touches: a code of the object or class, and noise; places on a unit square."""

    def __init__(self, noise=0.1, asked=lambda code: code, spread=1.0, by_object=0.0):
        self.noise, self.asked, self.spread, self.by_object = noise, asked, spread, by_object

    def feel(self, name, choice):
        random = rng(0, name)
        label = next((label for label, names in CLASSES.items() if name in names), name)
        code = rng(1, label).normal(size=41) + self.by_object * rng(2, name).normal(size=41)
        learned, queried = (
            part + self.noise * random.normal(size=(choice.points, 41)) for part in (code, self.asked(code))
        )
        places = np.c_[self.spread * random.random((choice.points, 2)), np.zeros(choice.points)]
        return Felt(learned, queried, places, 100, SECONDS)


def ask(made, seed=0, **options):
    first = {name: values[0] for name, values in SPACE.items()}
    return known(made, OBJECTS, choice_of(first | {"method": "random"} | options), EFFORT, seed)


def accuracy(rows, split):
    return np.mean([row["value"] for row in rows if row["split"] == split])


@pytest.mark.slow
def test_what_feels_as_it_was_learned_is_known_and_there_is_a_row_an_object():
    rows = ask(Made())
    assert accuracy(rows, "regions") == accuracy(rows, "objects") == 1
    assert sorted(row["item"] for row in rows) == sorted([*SHAPES, *sum(CLASSES.values(), ())])
    assert {row["group"] for row in rows if row["split"] == "objects"} == set(CLASSES)


@pytest.mark.slow
def test_learning_is_from_the_model_and_asking_of_the_object():
    rows = ask(Made(asked=lambda code: -code))
    assert accuracy(rows, "regions") < 0.6 and accuracy(rows, "objects") < 0.6


def test_unseen_objects_are_never_learned():
    rows = ask(Made(by_object=50))  # which drowns the code of the class
    assert accuracy(rows, "regions") == 1 and accuracy(rows, "objects") < 0.9


@pytest.mark.slow
def test_several_touches_vote_and_the_same_seed_gives_the_same_answers():
    single, again, other, five = (
        ask(Made(noise=4), seed, touches=count) for seed, count in ((0, 1), (0, 1), (1, 1), (0, 5))
    )
    assert accuracy(five, "objects") > accuracy(single, "objects") + 0.05
    first, second, third = ([row["value"] for row in rows] for rows in (single, again, other))
    assert first == second != third


@pytest.mark.slow
def test_seconds_are_the_sum_of_their_parts_and_learning_stands_apart():
    for row in ask(Made(), touches=3):
        assert row["seconds"] == pytest.approx(
            sum(row[part] for part in ("simplifying", "looking", "pressing", "asking"))
        )
        assert (row["simplifying"], row["looking"], row["pressing"]) == (1, 2, 0.5 + 3 * 0.25) and row["asking"] > 0
        assert row["training"] > 1 + 2 + 0.5 + 60 * 0.25


@pytest.mark.parametrize(("made", "options"), [(Made(spread=0.1), {}), (Made(), {"points": 20, "touches": 6})])
@pytest.mark.slow
def test_where_no_region_is_left_the_row_says_so(made, options):
    for row in ask(made, **options):
        if row["split"] == "regions":
            assert row["value"] is None and row["note"] == "too few touches in a region of it, or apart from it"


def everything(objects):
    return {*objects.shapes, *objects.classes, *(name for names in objects.classes.values() for name in names)}


def test_search_and_confirmation_share_no_object_and_follow_from_names_and_seed_alone():
    shapes = [f"shape{k}" for k in range(15)]
    classes = {f"class{k}": [f"{k}a", f"{k}b"] for k in range(6)}
    for seed in (0, 1):
        searched, unseen = halves(shapes, classes, seed)
        assert not everything(searched) & everything(unseen)
        assert everything(searched) | everything(unseen) == {*shapes, *classes, *sum(classes.values(), [])}
        assert (len(searched.shapes), len(unseen.shapes)) == (7, 8)
        assert len(searched.classes) == len(unseen.classes) == 3
    assert halves(shapes[::-1], dict(reversed(classes.items())), 1) == (searched, unseen) != halves(shapes, classes, 0)


def test_another_size_of_a_shape_is_no_shape_of_its_own():
    names = ["cubelarge", "cubesmall", "cubemedium", "cup", "small", "gamesmall"]
    assert shapes_of(names) == ["cubelarge", "cup", "gamesmall", "small"]


def test_sets_of_six_hold_each_shape_as_often():
    shapes = [f"shape{k}" for k in range(15)]
    sixes = Objects(tuple(shapes), {}).sixes(shapes=9, count=5, seed=0)
    assert all(len(set(six)) == 6 for six in sixes) and {name for six in sixes for name in six} == set(shapes[:9])
    often = [sum(name in six for six in sixes) for name in shapes[:9]]
    assert max(often) - min(often) <= 1
    with pytest.raises(ValueError, match="5 shapes to tell apart are too few: 6 are needed"):
        Objects(tuple(shapes[:5]), {}).sixes(20, 1, 0)


def test_objects_are_read_with_their_meshes_and_what_cannot_be_split_is_named_with_its_remedy(tmp_path):
    def write(dataset, names, classes=""):
        for name in names:
            write_mesh(tmp_path / dataset / f"meshes/{name}.npz", Mesh(np.eye(3), np.array([[0, 1, 2]])))
        write_text(tmp_path / dataset / "meshes/classes.csv", f"class,object\n{classes}")

    write("ours", ["b", "a"])
    with pytest.raises(ValueError, match=r"holds no meshes: .*sets=\[ours,theirs\].* `dvc repro meshes@theirs`"):
        read_objects(tmp_path, "ours", "theirs")
    write("theirs", ["x", "y"], "one,x\none,y\n")
    shapes, classes, files = read_objects(tmp_path, "ours", "theirs")
    assert (shapes, classes) == (["a", "b"], {"one": ["x", "y"]})
    assert set(files) == {*"abxy"} and all(path.exists() for path in files.values())
    write("same", ["a", "x"], "one,a\none,x\n")
    with pytest.raises(ValueError, match="a: objects of both ours and same; name other --classes"):
        read_objects(tmp_path, "ours", "same")
    write("few", ["x"], "one,x\n")
    with pytest.raises(ValueError, match="few: of class one no object can be held out"):
        read_objects(tmp_path, "ours", "few")
