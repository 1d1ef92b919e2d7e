"""The panel Know without a page: what is known, what hides, and who finds it out."""

from types import SimpleNamespace

import numpy as np
import pytest

from haptic_glance.know import NONE, learn, primitives
from haptic_glance.lod import write_any
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.studio.mystery import by_planner, gather, guess, study, verdict, without_stranger
from haptic_glance.studio.panels.know import KnowPanel
from haptic_glance.studio.session import Session
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
    meshes, notes = gather(files, None, table, True, None)
    assert set(meshes) == {*shapes, "brick", "ring"} and len(notes) == 1 and "broken.stl" in notes[0]
    assert set(gather([], None, None, False, tmp_path)[0]) == {"brick"}
    table = Specimen(Mesh(shapes["torus"].vertices, shapes["torus"].faces), "ball")
    meshes, _ = gather([], None, table, True, None)  # the mesh on the table wins over one of the same name
    assert len(meshes["ball"].faces) == len(shapes["torus"].faces)


@pytest.mark.slow
def test_a_hidden_object_is_one_of_the_known_by_lot(library, shapes):
    drawn = {guess(library, shapes, None, seed).name for seed in range(20)}
    assert len(drawn) > 3 and drawn <= set(shapes)
    game = guess(library, shapes, None, 0)
    assert game.hidden and game.name == guess(library, shapes, None, 0).name and game.touches == 0
    assert game.specimen.mesh.vertices.shape == shapes[game.name].vertices.shape
    shown = guess(library, shapes, Specimen(shapes["cone"], "cone"))
    assert not shown.hidden and shown.name == "cone"


@pytest.mark.slow
def test_an_object_that_may_lie_anywhere_hides_in_another_pose(shapes):
    anywhere, _ = study(shapes, placed=False)
    drawn = [guess(anywhere, shapes, None, seed) for seed in range(10)]
    for game in drawn:
        plain, hidden = shapes[game.name].vertices, game.specimen.mesh.vertices
        assert not np.allclose(hidden, plain, atol=0.1)
        shape = [np.linalg.norm(points - points.mean(axis=0), axis=1) for points in (plain, hidden)]
        assert np.corrcoef(*shape)[0, 1] > 0.999 or game.name == "ball"
    assert np.mean([game.exploration.finish() in (game.name, "") for game in drawn]) >= 0.7


def test_the_planner_tries_the_same_object_without_the_persons_touches(library, shapes):
    game = guess(library, shapes, None, 3)
    touches, known = by_planner(game)
    assert known == game.name and touches >= 1 and game.touches == 0


@pytest.mark.parametrize(
    ("person_answer", "planner", "expected"),
    [
        ("", (2, "cone"), "You gave up after 0 touches; the planner alone knew it after 2."),
        ("cone", (2, "cone"), "You knew it after 0 touches; the planner alone knew it after 2."),
        ("box", (3, "ball"), "You took it for box after 0 touches; the planner alone took it for ball after 3."),
        ("cone", (30, ""), "You knew it after 0 touches; the planner alone gave up after 30."),
    ],
)
def test_the_verdict_names_who_knew_it(library, shapes, person_answer, planner, expected):
    game = guess(library, shapes, Specimen(shapes["cone"], "cone"))
    game.person_answer = person_answer
    assert verdict(game, planner) == f"**It is cone.** {expected}"


def test_a_stranger_hides_in_half_of_the_games_and_the_mesh_on_the_table_is_not_learned(shapes):
    assert set(without_stranger(shapes, Specimen(shapes["cone"], "cone"))) == {*shapes} - {"cone"}
    assert without_stranger({}, None) == {}  # `learn` then says how many objects it needs
    known = without_stranger(shapes, None, seed=0)
    (stranger,) = {*shapes} - {*known}
    assert known == {name: shapes[name] for name in known}
    library, _ = study(known, placed=True, unknown=True)
    hidden = [guess(library, shapes, None, seed).name for seed in range(40)]
    assert 10 <= hidden.count(stranger) <= 30 and len(set(hidden)) > 3


@pytest.mark.parametrize(
    ("person_answer", "planner", "expected"),
    [
        (NONE, (4, NONE), "You knew it after 0 touches; the planner alone knew it after 4."),
        ("box", (2, "ball"), "You took it for box after 0 touches; the planner alone took it for ball after 2."),
    ],
)
def test_a_stranger_is_known_as_none_of_the_known_objects(shapes, person_answer, planner, expected):
    library, _ = study(without_stranger(shapes, Specimen(shapes["cone"], "cone")), placed=True, unknown=True)
    game = guess(library, shapes, Specimen(shapes["cone"], "cone"))
    game.person_answer = person_answer
    assert verdict(game, planner) == f"**It is cone, none of the known objects.** {expected}"


def test_the_verdict_counts_the_planners_help(library, shapes):
    game = guess(library, shapes, None, 3)
    game.exploration.touch(game.exploration.candidate(0))
    game.helped = 1
    assert "after 1 touch, 1 of them the planner's;" in verdict(game, (2, game.name))
    assert np.isclose(sum(game.exploration.belief.probabilities.values()), 1)


def test_the_planner_does_not_touch_an_object_that_came_meanwhile(library, shapes):
    """Otherwise it would never end: it counts the touches of the old one."""
    old, new = (guess(library, shapes, Specimen(shapes["cone"], "cone")) for _ in range(2))
    panel = KnowPanel(SimpleNamespace(session=Session(kept={"Know": new})))
    panel.touch_planned(old, old.exploration.candidate(0))
    assert old.touches == new.touches == 0


def test_a_touch_behind_another_panel_is_not_drawn(library, shapes):
    game = guess(library, shapes, Specimen(shapes["cone"], "cone"))
    panel = KnowPanel(SimpleNamespace(session=Session(kept={"Know": game}), panel=None))
    panel.bars, panel.about = SimpleNamespace(), SimpleNamespace()
    panel.touch_planned(game, game.exploration.candidate(0))
    panel.draw()
    assert game.touches == game.helped == 1 and panel.bars.visible
