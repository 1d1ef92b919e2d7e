"""Knowing by touch, on objects of which it is known what a hand would find."""

import sys

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import write_mesh
from haptic_glance.base.rng import rng
from haptic_glance.know import Exploration, Library, known_objects, learn, place_at, primitives, sample_places
from haptic_glance.know.exploration import FRESH
from haptic_glance.know.library import CELLS, PITCH, TOUCHES
from haptic_glance.lod import write_any
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Skin, Surface, press, press_at, sensor_axes
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


def felt(mesh, places):
    """Imprints (k, *CELLS) of an ideal array at places."""
    return press_at(Surface(mesh), places.positions, sensor_axes(places.normals), CELLS, PITCH)


@pytest.mark.parametrize("name", NAMES)
def test_touches_of_a_known_object_end_in_it(library, shapes, name):
    assert tuple(shapes) == NAMES and np.linalg.norm(shapes[name].vertices, axis=1).max() == pytest.approx(0.5)
    exploration = Exploration(library, Surface(shapes[name]), rng(3, name))
    assert exploration.finish() == name
    assert exploration.belief.probabilities[name] >= 0.95
    assert not any(belief.known for belief in exploration.beliefs[:-1])


def test_an_object_is_explored_as_a_mesh_too_but_in_another_scale_it_is_refused(library, shapes):
    cone = shapes["cone"]
    first, again = (Exploration(library, form, rng(3, "cone")) for form in (cone, Surface(cone)))
    np.testing.assert_array_equal(first.candidates.positions, again.candidates.positions)
    for scale in (0.1, 0.5, 2, 100):
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
    with pytest.raises(ValueError, match="position of three finite numbers"):
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


def test_an_object_may_lie_anywhere_unless_it_is_placed_and_a_known_place_helps(blind, shapes):
    aside = Mesh(shapes["torus"].vertices + [3.0, 1.0, 0.0], shapes["torus"].faces)
    belief = touched(blind, aside, 12).belief
    assert belief.known == "torus"
    assert belief.probabilities == pytest.approx(touched(blind, shapes["torus"], 12).belief.probabilities, abs=1e-6)
    turned = Mesh(ball(1).vertices * [-1, -1, 1], ball(1).faces)  # half a turn about the vertical
    pair = {"bump": ball(1), "turned": turned}
    beliefs = [touched(learn(pair, placed=placed), ball(1), 12).belief for placed in (True, False)]
    assert beliefs[0].known == "bump" and not beliefs[1].known


@pytest.mark.slow
def test_a_library_that_was_learned_through_a_faulty_skin_is_right_where_an_ideal_one_is_sure_and_wrong(shapes, blind):
    skin, right = Skin(dead=0.02), []
    for library in (blind, learn(shapes, placed=False, skin=skin)):
        answers = []
        for name in NAMES:
            for draw in range(4):
                belief = library.belief()
                places = sample_places(Surface(shapes[name]), 30, rng(draw, name))
                for image, position in zip(felt(shapes[name], places), places.positions, strict=True):
                    belief = belief if belief.known else belief.after(skin(image[None])[0], position)
                answers += [belief.known == name] if belief.known else []
        assert len(answers) > 12
        right.append(np.mean(answers))
    assert right[0] < 0.6 and right[1] > 0.85


def test_an_exploration_touches_with_the_sensor_of_its_library(shapes):
    names = ("ball", "box")
    library = learn({name: shapes[name] for name in names}, placed=False, skin=Skin(dead=0.1, noise=0.05))
    exploration = Exploration(library, shapes["box"], rng(0, "faulty"))
    first, again = (exploration.touch(exploration.candidate(0)) for _ in range(2))
    assert (first == 1).mean() >= 0.1 and not np.array_equal(first, again)  # a dead cell reads no load; noise is new


def test_an_exploration_turns_its_arrays_as_those_of_its_library_were(shapes, blind):
    pair = {name: shapes[name] for name in ("box", "torus")}
    explorations = [
        Exploration(library, shapes["box"], rng(0, "turn")) for library in (learn(pair, False, turned=True), blind)
    ]
    for exploration in explorations:
        for place in range(20):
            image = exploration.touch(exploration.candidate(place))
        felt_again = press_at(exploration.surface, exploration.positions[-1:], exploration.axes[-1:], CELLS, PITCH)[0]
        assert np.array_equal(image, felt_again)
    any_way, upright = (exploration.axes for exploration in explorations)
    normals = [exploration.candidates.normals[:20] for exploration in explorations]
    assert np.array_equal(upright, sensor_axes(normals[1]))
    turns = np.degrees(np.arccos(np.clip((any_way[:, 1] * sensor_axes(normals[0])[:, 1]).sum(1), -1, 1)))
    assert turns.min() < 40 and turns.max() > 140 and len(np.unique(turns)) == 20


def test_a_mesh_in_two_formats_is_equal_and_a_mesh_with_as_many_faces_is_not(shapes, recwarn):
    ball = shapes["ball"]
    corners = np.round(ball.vertices, 6)[ball.faces[::-1]].reshape(-1, 3)
    rounded = Mesh(corners, np.arange(len(corners)).reshape(-1, 3))
    longer = Mesh(ball.vertices * [1, 1, 1.01], ball.faces)
    learn({"ball": ball, "longer": longer}, placed=False)
    assert not recwarn.list
    with pytest.warns(UserWarning, match="ball and copy are the same mesh"):
        learn({"ball": ball, "copy": rounded}, placed=False)


def test_a_touch_away_from_all_objects_says_nothing_and_one_in_another_unit_is_refused(library, blind):
    flat = np.zeros(CELLS)
    values = library.belief().after(flat, [0, 0, 1.3]).values
    assert values == pytest.approx([1 / 6] * 6, abs=1e-4)
    with pytest.raises(ValueError, match=r"\[0.0, 0.0, 3.0\] is 2.\d+ units from .* units of the normalised object"):
        library.belief().after(flat, [0, 0, 3.0])
    assert blind.belief().after(flat, [0, 0, 3.0]).touches == 1


@pytest.mark.parametrize(
    ("names", "samples", "positions", "words"),
    [
        (("a", "a"), np.zeros((2, 9, 41)), np.zeros((2, 9, 3)), "names must differ, 'a' occurs twice"),
        (("a", "b", "c"), np.zeros((2, 9, 41)), np.zeros((2, 9, 3)), r"with 3 classes, .* got \(2, 9, 41\)"),
        (("a", "b"), np.zeros((2, 9, 41)), np.zeros((2, 8, 3)), r"got \(2, 9, 41\) and \(2, 8, 3\)"),
        (("a", "b"), np.zeros((2, 9, 4)), np.zeros((2, 9, 3)), r"\(classes, touches, 41\) .* got \(2, 9, 4\)"),
        (("a", "b"), np.zeros((2, 0, 41)), np.zeros((2, 0, 3)), r"got \(2, 0\) and"),
        (("a", "b"), np.full((2, 9, 41), np.nan), np.zeros((2, 9, 3)), "samples must be finite, got nan in touch 0"),
        (("a", "b"), np.full((2, 9, 41), 255), np.zeros((2, 9, 3)), "those of a are .* divide bytes by 255"),
    ],
)
def test_samples_that_do_not_fit_a_library_are_named(names, samples, positions, words):
    with pytest.raises(ValueError, match=words):
        Library(names, samples.tolist(), positions, False)


def test_places_depend_on_the_surface_and_not_on_the_order_in_which_a_file_has_it(shapes):
    mesh, random = shapes["cone"], np.random.default_rng(0)
    order, faces = random.permutation(len(mesh.vertices)), random.permutation(len(mesh.faces))
    other = Mesh(mesh.vertices[order], np.roll(np.argsort(order)[mesh.faces[faces]], 1, axis=1))
    first, second = (
        sample_places(Surface(surface_mesh), 64, rng(0, "order")).positions for surface_mesh in (mesh, other)
    )
    assert first == pytest.approx(second, abs=1e-12)


def test_a_mesh_with_y_up_is_learned_upright_and_explored_only_so(shapes):
    lying = Mesh(shapes["torus"].vertices[:, [1, 2, 0]], shapes["torus"].faces, up="y")
    library = learn({"ball": shapes["ball"], "torus": lying}, placed=False)
    assert library.calibration == learn({name: shapes[name] for name in ("ball", "torus")}, placed=False).calibration
    with pytest.raises(ValueError, match="has y up, .* call rotate_to_z_up"):
        Exploration(library, lying, rng(0, "lying"))


@pytest.mark.parametrize(
    ("image", "position", "words"),
    [
        (np.full(CELLS, 200.0), np.zeros(3), "bytes, or numbers in 0..1"),
        (np.full(CELLS, -1.0), np.zeros(3), "bytes, or numbers in 0..1"),
        (np.zeros(CELLS), 5, "three finite numbers"),
        (np.zeros(CELLS), [[0, 0, 0]], "three finite numbers"),
    ],
)
def test_what_is_no_imprint_or_no_place_is_refused(blind, image, position, words):
    with pytest.raises(ValueError, match=words):
        blind.belief().after(image, position)
    assert blind.belief().after(np.full(CELLS, 255, dtype=np.uint8), np.zeros(3)).touches == 1


def test_a_learned_touch_is_not_compared_with_itself():
    """Two objects with samples drawn alike: with itself counted each touch would favour its own object."""
    random = np.random.default_rng(0)
    samples, places = 0.1 * random.standard_normal((2, TOUCHES, 41)), random.standard_normal((2, TOUCHES, 3))
    scores = Library(("one", "two"), samples, places, False)._evidence.reshape(2, TOUCHES, 2)
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
    write_any(tmp_path / "line.ply", Mesh(np.arange(3.0)[:, None] * [1, 0, 0], np.array([[0, 1, 2]])))
    write_any(tmp_path / "._mug.stl", shapes["box"])
    (tmp_path / "notes.txt").write_text("no mesh")
    monkeypatch.setitem(sys.modules, "pymeshlab", None)
    (tmp_path / "cloud.xyz").write_text("\n".join(f"{i % 9} {i % 7} {i % 5}" for i in range(200)))
    meshes, notes = known_objects(tmp_path)
    assert list(meshes) == ["cubelarge", "mug_large", "mug_small", "small"]
    assert [note.partition(":")[0] for note in notes] == ["broken.stl", "cloud.xyz", "line.ply"]
    assert str(tmp_path) not in "".join(notes)
    assert np.linalg.norm(meshes["small"].vertices, axis=1).max() == pytest.approx(0.5)
    few, left_out = known_objects(tmp_path, most=1)
    assert not few and len(left_out) == 7  # the first by name is the broken one
    assert known_objects(tmp_path / "nowhere") == ({}, [])
    with pytest.raises(ValueError, match="small.stl is a file: give the folder"):
        known_objects(tmp_path / "small.stl")
    trimesh.Trimesh(shapes["box"].vertices, shapes["box"].faces).export(tmp_path / "small.stl")
    with pytest.warns(UserWarning, match="small.stl does not say which axis points up"):
        known_objects(tmp_path)
