"""The objects of the search and those that confirm it: stated beforehand, and apart."""

import numpy as np
import pytest

from haptic_glance.base.files import write_mesh, write_text
from haptic_glance.mesh.mesh import Mesh
from stages.front.known import Objects, halves, read_objects, shapes_of

SHAPES = [f"shape{k}" for k in range(15)]
CLASSES = {f"class{k}": [f"{k}a", f"{k}b"] for k in range(6)}


def everything(objects):
    return {*objects.shapes, *objects.classes, *(name for names in objects.classes.values() for name in names)}


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_search_and_confirmation_share_no_object(seed):
    searched, unseen = halves(SHAPES, CLASSES, seed)
    assert not everything(searched) & everything(unseen)
    assert everything(searched) | everything(unseen) == {*SHAPES, *CLASSES, *sum(CLASSES.values(), [])}
    assert (len(searched.shapes), len(unseen.shapes)) == (7, 8) and len(searched.classes) == len(unseen.classes) == 3


def test_the_halves_follow_from_names_and_seed_alone():
    assert halves(SHAPES, CLASSES, 0) == halves(SHAPES[::-1], dict(reversed(CLASSES.items())), 0)
    assert halves(SHAPES, CLASSES, 0) != halves(SHAPES, CLASSES, 1)


def test_another_size_of_a_shape_is_no_shape_of_its_own():
    assert shapes_of(["cubelarge", "cubesmall", "cubemedium", "cup", "small", "gamesmall"]) == [
        "cubelarge", "cup", "gamesmall", "small",
    ]  # fmt: skip


def test_sets_of_six_hold_each_shape_as_often():
    sixes = Objects(tuple(SHAPES), {}).sixes(shapes=9, count=5, seed=0)
    assert all(len(set(six)) == 6 for six in sixes) and {name for six in sixes for name in six} == set(SHAPES[:9])
    often = [sum(name in six for six in sixes) for name in SHAPES[:9]]
    assert max(often) - min(often) <= 1
    with pytest.raises(ValueError, match="5 shapes to tell apart are too few: 6 are needed"):
        Objects(tuple(SHAPES[:5]), {}).sixes(20, 1, 0)


@pytest.fixture
def written(tmp_path):
    mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]))

    def write(dataset, names, classes=""):
        for name in names:
            write_mesh(tmp_path / dataset / "meshes" / f"{name}.npz", mesh)
        write_text(tmp_path / dataset / "meshes" / "classes.csv", f"class,object\n{classes}")
        return tmp_path

    return write


def test_objects_are_read_with_their_meshes(written):
    data = written("ours", ["b", "a"]), written("theirs", ["x", "y"], "one,x\none,y\n")
    shapes, classes, files = read_objects(data[0], "ours", "theirs")
    assert (shapes, classes) == (["a", "b"], {"one": ["x", "y"]})
    assert set(files) == {*"abxy"} and all(path.exists() for path in files.values())


def test_what_cannot_be_split_is_named_with_its_remedy(written):
    data = written("ours", ["a"])
    with pytest.raises(ValueError, match=r"holds no meshes: .*sets=\[ours,theirs\].* `dvc repro meshes@theirs`"):
        read_objects(data, "ours", "theirs")
    written("theirs", ["a", "x"], "one,a\none,x\n")
    with pytest.raises(ValueError, match="a: objects of both ours and theirs; name other --classes"):
        read_objects(data, "ours", "theirs")
    written("few", ["x"], "one,x\n")
    with pytest.raises(ValueError, match="few: of class one no object can be held out"):
        read_objects(data, "ours", "few")
