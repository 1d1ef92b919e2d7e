"""The panel Know without a page: what is known, what hides, and who finds it out."""

import numpy as np
import pytest

from haptic_glance.know import learn, primitives
from haptic_glance.lod import write_any
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.studio.mystery import by_planner, gather, guess, study, verdict
from haptic_glance.studio.specimen import Specimen


@pytest.fixture(scope="module")
def shapes():
    return primitives()


@pytest.fixture(scope="module")
def library(shapes):
    return learn(shapes)


def test_everything_that_was_opened_is_known(tmp_path, shapes):
    write_any(tmp_path / "brick.stl", shapes["box"])
    (tmp_path / "broken.stl").write_bytes(b"nothing")
    table = Specimen(shapes["torus"], "ring")
    files = [tmp_path / "brick.stl", tmp_path / "broken.stl"]
    found, notes = gather(files, None, table, True, None)
    assert set(found) == {*shapes, "brick", "ring"} and len(notes) == 1 and "broken.stl" in notes[0]
    assert set(gather([], None, None, False, tmp_path)[0]) == {"brick"}
    table = Specimen(Mesh(shapes["torus"].vertices, shapes["torus"].faces), "ball")
    found, _ = gather([], None, table, True, None)  # the mesh on the table wins over one of the same name
    assert len(found["ball"].faces) == len(shapes["torus"].faces)


@pytest.mark.slow
def test_a_hidden_object_is_one_of_the_known_by_lot(library, shapes):
    drawn = {guess(library, shapes, None, seed).name for seed in range(20)}
    assert len(drawn) > 3 and drawn <= set(shapes)
    one = guess(library, shapes, None, 0)
    assert one.hidden and one.name == guess(library, shapes, None, 0).name and one.touches == 0
    assert one.specimen.mesh.vertices.shape == shapes[one.name].vertices.shape
    shown = guess(library, shapes, Specimen(shapes["cone"], "cone"))
    assert not shown.hidden and shown.name == "cone"


@pytest.mark.slow
def test_an_object_that_may_lie_anywhere_hides_in_another_pose(shapes):
    anywhere, _ = study(shapes, placed=False)
    drawn = [guess(anywhere, shapes, None, seed) for seed in range(10)]
    for one in drawn:
        given, found = shapes[one.name].vertices, one.specimen.mesh.vertices
        assert not np.allclose(found, given, atol=0.1)
        shape = [np.linalg.norm(points - points.mean(axis=0), axis=1) for points in (given, found)]
        assert np.corrcoef(*shape)[0, 1] > 0.999 or one.name == "ball"
    assert np.mean([one.exploration.finish() in (one.name, "") for one in drawn]) >= 0.7


def test_the_planner_tries_the_same_object_without_the_persons_touches(library, shapes):
    one = guess(library, shapes, None, 3)
    touches, known = by_planner(one)
    assert known == one.name and touches >= 1 and one.touches == 0


@pytest.mark.parametrize(
    ("said", "planner", "expected"),
    [
        ("", (2, "cone"), "You gave up after 0 touches; the planner alone knew it after 2."),
        ("cone", (2, "cone"), "You knew it after 0 touches; the planner alone knew it after 2."),
        ("box", (3, "ball"), "You took it for box after 0 touches; the planner alone took it for ball after 3."),
        ("cone", (30, ""), "You knew it after 0 touches; the planner alone gave up after 30."),
    ],
)
def test_the_verdict_names_who_knew_it(library, shapes, said, planner, expected):
    one = guess(library, shapes, Specimen(shapes["cone"], "cone"))
    one.said = said
    assert verdict(one, planner) == f"**It is cone.** {expected}"


def test_the_verdict_counts_the_planners_help(library, shapes):
    one = guess(library, shapes, None, 3)
    one.exploration.touch(one.exploration.candidate(0))
    one.helped = 1
    assert "after 1 touch, 1 of them the planner's;" in verdict(one, (2, one.name))
    assert np.isclose(sum(one.exploration.belief.probabilities.values()), 1)
