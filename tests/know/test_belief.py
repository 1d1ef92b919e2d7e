"""The belief that a look and touches share, by value where the truth is known."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from haptic_glance import Viewpoint, render
from haptic_glance.know import NONE, PressureArray, learn, primitives, stand, touch_until_known
from haptic_glance.know.library import AWAY, DEFAULT
from haptic_glance.know.particles import KEPT, refined
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface

CAMERA = Viewpoint(0, 35)


@pytest.fixture(scope="module")
def shapes():
    return primitives()


@pytest.fixture(scope="module")
def library(shapes):
    return learn(shapes)


def made(shape):
    return Mesh(np.asarray(shape.vertices), np.asarray(shape.faces), up="z")


def ball(radius=0.5):
    return made(trimesh.creation.icosphere(4, radius=radius))


def picture_of(mesh, camera=CAMERA):
    return render(mesh, camera, size=(96, 96)).rgb


def felt(belief, mesh, lines):
    """The belief after touches along lines of the library."""
    for line in lines:
        approach = belief.library.line(line)
        belief = belief.after(approach, *approach.feel(mesh))
    return belief


@pytest.mark.parametrize("pose", ["fixed", "turned", "any"])
def test_the_table_predicts_what_the_mesh_in_its_pose_feels(shapes, pose):
    library = learn({name: shapes[name] for name in ("box", "cone")}, pose=pose)
    random = np.random.default_rng(0)
    for line in random.integers(library.grid.lines, size=3):
        approach = library.line(line)
        travels, reliefs = library.predict(library.hypotheses, approach)
        for number in random.integers(len(library.hypotheses), size=4):
            one = library.hypotheses[np.array([number])]
            there = stand(shapes[library.names[one.objects[0]]], rotation=one.rotations[0])
            travel, imprint = replace(approach, array=replace(library.sensor, travel_noise=0, relief_noise=0)).feel(
                there
            )
            expected = travel / library.diameter if np.isfinite(travel) else AWAY
            assert travels[number] == pytest.approx(expected, abs=1e-5)
            assert reliefs[number] == pytest.approx(imprint.ravel() / library.sensor.depth, abs=3e-3)  # bytes


def test_a_touch_adds_its_weighted_likelihood(library, shapes):
    there = stand(shapes["box"], turn=33)
    belief, total = library.belief(), np.full(len(library.hypotheses), -np.log(len(library.hypotheses)))
    weights = []
    for line in (5, 5, 300):
        approach = library.line(line)
        travel, imprint = approach.feel(there)
        belief = belief.after(approach, travel, imprint)
        travels, reliefs = library.predict(library.hypotheses, approach)
        squares = ((reliefs - imprint.ravel() / library.sensor.depth) ** 2).mean(axis=1)
        weights.append(belief.touches[-1].weight)
        total += weights[-1] * library.likelihood.of_touch(travels - travel / library.diameter, squares)
    assert belief.log_weights == pytest.approx(total, abs=1e-3)
    model = library.likelihood
    assert weights[:2] == pytest.approx([1, 1 / (1 + model.repeated)]) and weights[2] < 1
    sums = [np.exp(total[library.hypotheses.objects == number]).sum() for number in range(len(library.names))]
    assert belief.values == pytest.approx(np.array(sums) / np.sum(sums), abs=1e-4)
    assert sum(belief.probabilities.values()) == pytest.approx(1)
    assert belief.name == next(iter(belief.probabilities)) == library.names[int(np.argmax(sums))]


def test_a_line_of_ones_own_is_predicted_as_a_line_of_the_library(library, shapes):
    there, line = stand(shapes["cone"], turn=100), library.line(200)
    own = library.approach(line.origin, line.direction, up=line.axes[1])
    assert own.axes == pytest.approx(line.axes) and own.line == -1
    touch = line.feel(there)
    first, second = library.belief().after(line, *touch), library.belief().after(own, *touch)
    assert second.values == pytest.approx(first.values, abs=0.02)
    upright = library.approach([0.9, 0, 0.1], [-2, 0, 0])
    assert upright.axes == pytest.approx(np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]))


def test_a_look_names_the_object_and_its_azimuth_and_a_touch_goes_on_from_there(library, shapes):
    there = stand(shapes["box"], turn=62)
    for camera in (CAMERA, Viewpoint(100, 35), Viewpoint(-20, 20, 15)):
        belief = library.look(picture_of(there, camera), camera)
        assert belief.known == "box" and min(abs(belief.pose.turn % 180 - 62), 180) < 5
    after = felt(belief, there, [10])
    assert after.known == "box" and after.touches[0].approach.line == 10


def test_a_look_of_unknown_camera_tells_the_name_and_not_the_azimuth(library, shapes):
    belief = library.look(picture_of(stand(shapes["torus"]), Viewpoint(70, 30)))
    assert belief.name == "torus"
    of_box = belief.log_weights[belief.hypotheses.objects == library.names.index("box")]
    assert np.ptp(of_box) == pytest.approx(0, abs=1e-9)


def test_what_is_hidden_is_left_out_of_the_look(library, shapes):
    there = stand(shapes["cone"], turn=10)
    picture = picture_of(there).copy()
    hidden = np.zeros(picture.shape[:2], dtype=bool)
    hidden[:, :50] = True
    picture[hidden] = np.random.default_rng(0).integers(0, 255, (hidden.sum(), 3))
    told = library.look(picture, CAMERA, hidden=hidden)
    assert told.known == "cone"
    assert told.values[0] != pytest.approx(library.look(picture, CAMERA).values[0])


def test_a_misleading_look_is_overcome_by_touches(library, shapes):
    wrong = library.look(picture_of(stand(shapes["torus"])), CAMERA)
    assert wrong.known == "torus"
    assert felt(wrong, stand(shapes["cone"]), [3, 100, 250, 400, 600, 700]).name == "cone"


def test_planned_touches_name_each_shape_in_each_pose(shapes):
    for pose, rotation in (("turned", None), ("any", Rotation.random(random_state=3).as_matrix())):
        library = learn(shapes, pose=pose)
        for name in shapes:
            there = stand(shapes[name], turn=77, rotation=rotation)
            *_, last = touch_until_known(library.belief(), there)
            assert last.belief.known == name


def test_the_next_touch_goes_where_the_candidates_differ():
    sphere = ball()
    bumped = sphere.vertices.copy()
    near = np.linalg.norm(bumped - [0, 0.5, 0], axis=1) < 0.15
    bumped[near] *= 0.8
    library = learn({"plain": sphere, "dented": Mesh(bumped, sphere.faces, up="z")}, pose="fixed")
    approach = library.belief().next_touch()
    contact = approach.contact(approach.feel(sphere)[0])
    assert np.linalg.norm(contact - [0, 0.5, 0]) < 0.25


def test_the_hand_goes_only_where_it_can_reach(library):
    approach = library.belief().next_touch(lambda origins, directions: origins[:, 0] > 0.6)
    assert approach.origin[0] > 0.6
    with pytest.raises(ValueError, match="no line that can be reached"):
        library.belief().next_touch(lambda origins, directions: np.zeros(len(origins)))
    with pytest.raises(ValueError, match="768 lines"):
        library.belief().next_touch(lambda origins, directions: True)


def test_no_line_is_touched_twice(library, shapes):
    belief = felt(library.belief(), stand(shapes["ball"]), range(0, 768, 8))
    assert belief.next_touch().line % 8


def test_a_unit_changes_nothing(shapes):
    metres = {name: Mesh(0.1 * mesh.vertices, mesh.faces, up="z") for name, mesh in shapes.items()}
    large = {name: Mesh(100 * mesh.vertices, mesh.faces, up="z") for name, mesh in shapes.items()}
    first, second = (
        felt(learn(meshes).belief(), stand(meshes["box"], turn=20), [7, 300, 500]) for meshes in (metres, large)
    )
    assert first.values == pytest.approx(second.values, abs=1e-3)
    assert first.pose.turn == second.pose.turn and first.library.diameter == pytest.approx(0.1, rel=1e-3)


def test_size_tells_objects_apart_and_so_does_a_touch_that_meets_nothing():
    library = learn({"marble": ball(0.005), "ball": ball(0.02)}, sensor=PressureArray((4, 4), 0.002, 0.004))
    assert felt(library.belief(), ball(0.02), [40]).known == "ball"
    beside = library.approach([0.05, 0.012, 0], [-1, 0, 0])
    assert beside.feel(ball(0.005))[0] == np.inf
    assert library.belief().after(beside, *beside.feel(ball(0.005))).known == "marble"


def test_position_and_size_within_their_tolerances_are_found(shapes):
    meshes = {name: shapes[name] for name in ("box", "cone", "torus")}
    library = learn(meshes, pose="turned", position=0.05, size=0.1)
    true = stand(shapes["box"], turn=30)
    there = Mesh(1.08 * true.vertices + [0.04, -0.03, 0.02], true.faces, up="z")
    *_, last = touch_until_known(library.belief(), there)
    assert last.belief.known == "box"
    belief = felt(last.belief, there, range(20, 768, 60))
    assert belief.pose.shift == pytest.approx([0.04, -0.03, 0.02], abs=0.02)
    assert 1.01 < belief.pose.size < 1.1
    assert np.abs(belief.hypotheses.shifts).max() <= library.position
    assert np.abs(belief.hypotheses.sizes - 1).max() <= 0.1 + 1e-12


def test_hypotheses_are_drawn_anew_with_the_same_total(shapes):
    library = learn({"box": shapes["box"], "cone": shapes["cone"]}, position=0.02)
    belief = felt(library.belief(), stand(shapes["box"]), [10])
    peaked = np.where(np.arange(len(belief.hypotheses)) < 3, belief.log_weights, belief.log_weights - 60)
    here, weights = refined(library, belief.hypotheses, peaked, (), lambda *_: np.zeros(KEPT)[: len(_[1])])
    assert len(here) == KEPT and np.log(np.exp(weights).sum()) == pytest.approx(np.log(np.exp(peaked).sum()))
    objects = belief.hypotheses.objects[:3]
    assert set(here.objects) <= set(objects) and np.abs(here.shifts).max() <= library.position


def test_equal_meshes_are_said_and_share_the_probability(shapes):
    with pytest.warns(UserWarning, match="cone and twin are the same shape: they cannot be told apart"):
        library = learn({"cone": shapes["cone"], "twin": shapes["cone"], "ball": shapes["ball"]})
    belief = felt(library.belief(), stand(shapes["cone"]), [3, 200, 500])
    assert belief.known == "" and belief.values == pytest.approx([0.5, 0.5, 0], abs=0.01)


def test_an_object_that_was_never_learned_is_none_of_these(shapes):
    known = {name: mesh for name, mesh in shapes.items() if name != "torus"}
    library = learn(known, unknown=True)
    assert library.belief().none == 0.5 and library.belief().probabilities[NONE] == 0.5
    *_, last = touch_until_known(library.belief(), stand(shapes["torus"], turn=9), most=8)
    assert last.belief.known == NONE and last.belief.values.sum() == pytest.approx(1 - last.belief.none)
    *_, last = touch_until_known(library.belief(), stand(shapes["box"], turn=9), most=12)
    assert last.belief.none < 0.5 and last.belief.name == "box"
    with pytest.raises(ValueError, match="needs 3 known objects or more, got 2"):
        learn({name: shapes[name] for name in ("box", "cone")}, unknown=True)
    with pytest.raises(ValueError, match="rename it"):
        learn({**known, NONE: shapes["torus"]}, unknown=True)
    with pytest.raises(ValueError, match="leave out position and size"):
        learn(known, unknown=True, size=0.1)


def test_one_object_is_known_at_once(shapes):
    assert learn({"cone": shapes["cone"]}).belief().known == "cone"


def test_a_class_that_is_told_leaves_its_objects(library):
    belief = library.belief().among(["box", "cone"])
    assert belief.values.max() == pytest.approx(0.5) and belief.probabilities["ball"] < 1e-9
    for names, words in ((["bax"], "unknown object 'bax'"), ([], "at least one name")):
        with pytest.raises(ValueError, match=words):
            library.belief().among(names)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({}, "no mesh"), ({"pose": "upside"}, "unknown pose"), ({"position": -1}, "position"), ({"size": 1.0}, "size"),
        ({"size": np.nan}, "size"),
    ],
)  # fmt: skip
def test_what_cannot_be_learned_is_named(shapes, arguments, words):
    meshes = {"box": shapes["box"]} if arguments else {}
    with pytest.raises(ValueError, match=words):
        learn(meshes, **arguments)


def test_meshes_and_sensors_of_other_kinds_are_named(shapes):
    with pytest.raises(TypeError, match="mapping"):
        learn([shapes["box"]])
    with pytest.raises(TypeError, match="texts as names"):
        learn({1: shapes["box"]})
    with pytest.raises(TypeError, match="PressureArray"):
        learn({"box": shapes["box"]}, sensor=(8, 8))
    flat = Mesh(np.zeros((3, 3)), np.array([[0, 1, 2]]), up="z")
    with pytest.raises(ValueError, match="^flat: "):
        learn({"box": shapes["box"], "flat": flat})


def test_a_look_that_cannot_be_is_named(library, shapes):
    picture = picture_of(shapes["box"])
    with pytest.raises(ValueError, match="30 degrees below the horizon"):
        library.look(picture, Viewpoint(0, -30))
    with pytest.raises(TypeError, match="camera must be a Viewpoint"):
        library.look(picture, (0, 35))
    assert learn(dict(list(shapes.items())[:1]), pose="fixed").look(picture, CAMERA).known


def test_a_touch_that_cannot_be_is_named(library, shapes):
    approach = library.line(100)
    travel, imprint = approach.feel(shapes["box"])
    belief = library.belief()
    with pytest.raises(ValueError, match="give the travel in the unit of the meshes"):
        belief.after(approach, travel / 1000, imprint)
    with pytest.raises(ValueError, match="give the travel in the unit of the meshes"):
        belief.after(approach, travel * 1000, imprint)
    with pytest.raises(ValueError, match="another array"):
        belief.after(replace(approach, array=DEFAULT.scaled(2)), travel, imprint)
    with pytest.raises(ValueError, match="8, 8"):
        belief.after(approach, travel, imprint[:3])
    assert belief.after(approach, np.inf, None).touches[0].travel == AWAY  # nothing was met, and nothing was felt
    for origin, direction in (([0, 0], [1, 0, 0]), ([0, 0, 0], [0, 0, 0]), ([0, 0, np.inf], [1, 0, 0])):
        with pytest.raises(ValueError, match="direction"):
            library.approach(origin, direction)


def test_a_pose_is_that_of_the_mesh(shapes):
    library = learn(shapes, pose="any")
    rotation = Rotation.random(random_state=5).as_matrix()
    *_, last = touch_until_known(library.belief(), Surface(stand(shapes["box"], rotation=rotation)), most=12)
    corner = np.linalg.norm(shapes["box"].vertices @ last.belief.pose.rotation.T, axis=1)
    assert corner == pytest.approx(np.linalg.norm(shapes["box"].vertices, axis=1))
    assert last.belief.pose.size == pytest.approx(1) and not last.belief.pose.shift.any()


def test_a_mesh_stands_where_it_is_asked_to(shapes):
    lying = Mesh(shapes["cone"].vertices[:, [1, 2, 0]] + 5, shapes["cone"].faces, up="y")
    there = stand(lying, turn=90, shift=[1, 2, 3])
    low, high = there.vertices.min(axis=0), there.vertices.max(axis=0)
    assert (low + high) / 2 == pytest.approx([1, 2, 3], abs=1e-9) and there.up == "z"
    plain = stand(shapes["cone"]).vertices
    assert there.vertices - [1, 2, 3] == pytest.approx(np.stack([-plain[:, 1], plain[:, 0], plain[:, 2]], axis=1))
