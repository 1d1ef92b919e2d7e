"""Knowing by touch, on objects of which it is known what a hand would find."""

import sys

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import write_mesh
from haptic_glance.base.rng import rng
from haptic_glance.know import Exploration, Library, known_objects, learn, place_at, primitives, sample_places
from haptic_glance.know.exploration import FRESH
from haptic_glance.know.library import CELLS, TOUCHES
from haptic_glance.lod import write_any
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, press
from haptic_glance.touch.places import Places

NAMES = ("ball", "box", "capsule", "cone", "cylinder", "torus")
TOP = np.array([0.0, 0.6, 0.8])


@pytest.fixture(scope="module")
def shapes():
    return primitives()


@pytest.fixture(scope="module")
def library(shapes):
    return learn(shapes)


@pytest.fixture(scope="module")
def blind(shapes):
    """A library without places: its likelihood depends on the imprint alone."""
    return learn(shapes, placed=False)


def ball(bump):
    """A ball of radius 0.4 with, or without, a bump of 0.1 on one side, as wide as the array."""
    shape = trimesh.creation.icosphere(subdivisions=5)
    towards = np.asarray(shape.vertices)
    angle = np.arccos(np.clip(towards @ TOP, -1, 1))
    return Mesh(towards * (0.4 + 0.1 * bump * np.exp(-((angle / 0.3) ** 2)))[:, None], np.asarray(shape.faces))


def touched(library, mesh, count, name="again"):
    exploration = Exploration(library, Surface(mesh), rng(7, name))
    for place in range(count):
        exploration.touch(exploration.candidate(place))
    return exploration


@pytest.mark.parametrize("name", NAMES)
def test_touches_of_a_known_object_end_in_it(library, shapes, name):
    assert tuple(shapes) == NAMES and np.linalg.norm(shapes[name].vertices, axis=1).max() == pytest.approx(0.5)
    exploration = Exploration(library, Surface(shapes[name]), rng(3, name))
    assert exploration.finish() == name
    assert exploration.belief.probabilities[name] >= 0.95
    assert not any(belief.known for belief in exploration.beliefs[:-1])


def test_an_object_is_explored_as_a_mesh_too_but_in_another_scale_it_is_refused(library, shapes):
    cone = shapes["cone"]
    first, again = (Exploration(library, given, rng(3, "cone")) for given in (cone, Surface(cone)))
    np.testing.assert_array_equal(first.candidates.positions, again.candidates.positions)
    for scale in (0.1, 100):
        with pytest.raises(ValueError, match="normalise it"):
            Exploration(library, Mesh(cone.vertices * scale, cone.faces), rng(3, "cone"))


def test_the_gain_is_none_where_the_object_is_known(library, shapes):
    exploration = Exploration(library, Surface(shapes["torus"]), rng(3, "torus"))
    first = library.gains(exploration.belief, exploration.expected)
    exploration.finish()
    known = library.gains(exploration.belief, exploration.expected)
    assert 0.3 < first.max() < np.log(6) + 1e-9 and abs(known).max() < 0.2


def test_the_belief_sums_to_one_and_begins_even(library, shapes):
    exploration = touched(library, shapes["cone"], 6)
    for belief in exploration.beliefs:
        assert sum(belief.probabilities.values()) == pytest.approx(1)
    assert list(exploration.beliefs[0].probabilities.values()) == pytest.approx([1 / 6] * 6)
    ordered = list(exploration.belief.probabilities.values())
    assert ordered == sorted(ordered, reverse=True)


def test_a_pair_that_feels_the_same_stays_undecided(shapes):
    pair = learn({"box": shapes["box"], "one": shapes["torus"], "two": shapes["torus"]})
    exploration = touched(pair, shapes["torus"], 15)
    belief = exploration.belief.probabilities
    assert belief["box"] < 0.01 and max(belief["one"], belief["two"]) < 0.95
    assert exploration.finish() == "" and len(exploration.images) <= 30
    again = Exploration(pair, Surface(shapes["torus"]), rng(4, "torus"))
    assert again.finish(1) == "" and len(again.images) == 1 and again.next_place() is not None


def test_one_mesh_under_two_names_is_neither_and_the_other_object_is_known(shapes):
    twins = learn({"mug 1": shapes["capsule"], "mug 2": shapes["capsule"], "ball": shapes["ball"]})
    draws = map(np.random.default_rng, range(6))
    assert {Exploration(twins, shapes["capsule"], draw).finish() for draw in draws} == {""}
    assert Exploration(twins, shapes["ball"], rng(0, "ball")).finish() == "ball"


def test_a_second_touch_of_a_place_and_a_position_without_a_number_are_no_evidence(library, shapes):
    exploration = Exploration(library, shapes["box"], rng(0, "again"))
    exploration.touch(exploration.candidate(3))
    before = exploration.belief
    exploration.touch(exploration.candidate(3))
    assert exploration.belief is before and len(exploration.images) == 2
    exploration.touch(exploration.candidate(4))
    assert exploration.belief.touches == 2
    with pytest.raises(ValueError, match="position of finite numbers"):
        before.after(exploration.images[0], np.array([0, np.nan, 0]))


@pytest.mark.slow
def test_belief_is_as_right_as_it_says(library, shapes):
    """Calibrated within what 120 explorations of four touches can tell."""
    confidence, right = [], []
    for name in NAMES:
        for draw in range(20):
            belief = touched(library, shapes[name], 4, f"{name} {draw}").belief
            confidence.append(belief.values.max())
            right.append(next(iter(belief.probabilities)) == name)
    assert np.mean(confidence) == pytest.approx(np.mean(right), abs=0.1)


def test_the_next_touch_goes_where_two_objects_differ():
    pair = learn({"bump": ball(1), "plain": ball(0)})
    for name, bump in (("bump", 1), ("plain", 0)):
        exploration = Exploration(pair, Surface(ball(bump)), rng(0, "bump"))
        place, gains = exploration.next_place(), exploration.gains()
        assert place is not None and np.linalg.norm(place.positions[0] - 0.4 * TOP) < 0.25
        far = np.linalg.norm(exploration.candidates.positions - 0.4 * TOP, axis=1) > 0.5
        assert gains.max() > 0.1 and gains.max() > 5 * abs(gains[far]).max()
        exploration.touch(place)
        assert exploration.belief.probabilities[name] > 0.7


def test_no_place_is_touched_again_and_the_planner_stops_where_nothing_is_fresh(library, shapes):
    exploration = Exploration(library, Surface(shapes["ball"]), rng(3, "ball"))
    for _ in range(12):
        place = exploration.next_place()
        if place is None:
            break
        exploration.touch(place)
    apart = np.linalg.norm(exploration.positions[:, None] - exploration.positions[None], axis=2)
    assert len(apart) > 2 and apart[~np.eye(len(apart), dtype=bool)].min() > FRESH
    exploration.positions = exploration.candidates.positions
    assert exploration.next_place() is None


def test_a_mesh_is_learned_once_and_by_its_content(library, blind, shapes):
    copies = {name: Mesh(mesh.vertices.copy(), mesh.faces.copy()) for name, mesh in shapes.items()}
    assert learn(copies) is learn(shapes) and blind is not library
    pair = {"ball": shapes["ball"], "box": shapes["box"]}
    assert learn(pair) is not learn(pair | {"ball": Mesh(shapes["ball"].vertices * 0.9, shapes["ball"].faces)})


def test_an_object_may_lie_anywhere_unless_it_is_placed_and_a_known_place_helps(library, blind, shapes):
    aside = Mesh(shapes["torus"].vertices + [3.0, 1.0, 0.0], shapes["torus"].faces)
    belief = touched(blind, aside, 12).belief
    assert belief.known == "torus"
    assert belief.probabilities == pytest.approx(touched(blind, shapes["torus"], 12).belief.probabilities, abs=1e-6)
    right = [np.mean([touched(known, shapes[name], 2).belief.probabilities[name] for name in NAMES])
             for known in (library, blind)]  # fmt: skip
    assert right[0] > right[1] + 0.1


def test_what_cannot_be_learned_or_felt_is_named(library, shapes):
    with pytest.raises(ValueError, match="at least two"):
        learn({"ball": shapes["ball"]})
    flat = Mesh(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    with pytest.raises(ValueError, match="nothing: cannot sample a mesh without area"):
        learn({"ball": shapes["ball"], "nothing": flat})
    with pytest.raises(ValueError, match="large: the object's diagonal is .* normalise it"):
        learn({"ball": shapes["ball"], "large": Mesh(100 * shapes["ball"].vertices, shapes["ball"].faces)})
    with pytest.raises(ValueError, match=r"learned with \(16, 16\) cells"):
        library.log_likelihoods(np.zeros((1, 8, 8)), np.zeros((1, 3)))


def test_a_learned_touch_is_not_compared_with_itself():
    """Two objects with samples drawn alike: with itself counted each touch would favour its own object."""
    random = np.random.default_rng(0)
    samples, places = random.standard_normal((2, TOUCHES, 41)), random.standard_normal((2, TOUCHES, 3))
    scores = Library(("one", "two"), samples, places, False)._own.reshape(2, TOUCHES, 2)
    ahead = np.stack([scores[0, :, 0] - scores[0, :, 1], scores[1, :, 1] - scores[1, :, 0]])
    assert abs(ahead.mean()) < 0.05


def test_a_place_near_a_vertex_is_the_vertex_and_a_large_face_keeps_its_normal(shapes):
    ball, box = Surface(shapes["ball"]), Surface(shapes["box"])
    places = sample_places(ball, 50, rng(0, "ball"))
    at = places.vertices >= 0
    assert at.any() and np.array_equal(places.positions[at], shapes["ball"].vertices[places.vertices[at]])
    middle = shapes["box"].vertices[shapes["box"].faces[:1]].mean(axis=1)
    place = place_at(box, middle, np.array([0]))
    assert place.vertices[0] == -1 and np.allclose(place.normals[0], shapes["box"].face_normals[0])


def test_a_touch_at_a_vertex_is_what_press_feels(library, shapes):
    mesh = shapes["cone"]
    exploration = Exploration(library, Surface(mesh), rng(0, "cone"))
    vertex = int(mesh.faces[0, 0])
    place = place_at(exploration.surface, mesh.vertices[[vertex]], np.array([0]))
    assert np.array_equal(exploration.touch(place), press(mesh, vertex, CELLS))
    assert isinstance(place, Places) and len(exploration.images) == exploration.belief.touches == 1


def test_a_folder_gives_its_meshes_and_names_what_it_leaves_out(tmp_path, shapes, monkeypatch):
    for name in ("cubelarge.npz", "cubesmall.npz"):  # as the pipeline has them
        write_mesh(tmp_path / name, shapes["box"])
    for name in ("mug_small.stl", "mug_large.stl", "small.stl"):
        write_any(tmp_path / name, shapes["box"])
    (tmp_path / "broken.stl").write_bytes(b"solid nothing")
    (tmp_path / "notes.txt").write_text("no mesh")
    monkeypatch.setitem(sys.modules, "pymeshlab", None)
    (tmp_path / "cloud.xyz").write_text("\n".join(f"{i % 9} {i % 7} {i % 5}" for i in range(200)))
    meshes, notes = known_objects(tmp_path)
    assert list(meshes) == ["cubelarge", "mug_large", "mug_small", "small"]
    assert [note.partition(":")[0] for note in notes] == ["broken.stl", "cloud.xyz"]
    assert str(tmp_path) not in "".join(notes)
    assert np.linalg.norm(meshes["small"].vertices, axis=1).max() == pytest.approx(0.5)
    few, left_out = known_objects(tmp_path, most=1)
    assert not few and len(left_out) == 6  # the first by name is the broken one
    assert known_objects(tmp_path / "nowhere") == ({}, [])


def test_files_that_differ_in_their_suffix_alone_are_two_objects(tmp_path, shapes):
    for shape, name in (("box", "thing.stl"), ("cone", "thing.ply")):
        write_any(tmp_path / name, shapes[shape])
    assert list(known_objects(str(tmp_path))[0]) == ["thing.ply", "thing.stl"]
