"""Objects in drawn poses, and the ways to choose where to touch."""

from dataclasses import replace

import numpy as np
import pytest

from haptic_glance.know import learn, primitives
from haptic_glance.know.sight import board
from stages.look_and_touch.protocol import CAMERA, POLICIES, Case, Disturbance, touch_on


@pytest.fixture(scope="module")
def library():
    return learn(primitives())


def case_of(library, name="box", pose=0, **changes):
    return Case(library, name, primitives()[name], pose, replace(Disturbance(), **changes))


@pytest.mark.parametrize("share", [0.0, 0.3, 0.6, 0.95])
def test_a_board_hides_the_asked_share_of_the_object(library, share):
    _, is_object = case_of(library).view
    for draw in range(5):
        mask = board(is_object, share, np.random.default_rng(draw))
        assert mask[is_object].mean() == pytest.approx(share, abs=0.02)
    assert not board(np.zeros((9, 9), dtype=bool), 0.5, np.random.default_rng(0)).any()


def test_a_case_stands_where_its_disturbance_says(library):
    plain, moved = case_of(library), case_of(library, position=0.1)
    larger = case_of(library, size=1.2, position=0.0)
    assert plain.azimuth == moved.azimuth and case_of(library, pose=1).azimuth != plain.azimuth
    centre = lambda case: (case.there.vertices.min(axis=0) + case.there.vertices.max(axis=0)) / 2  # noqa: E731
    assert centre(moved) == pytest.approx(10 * centre(plain)) and np.abs(centre(plain)).max() <= 0.02
    assert np.linalg.norm(larger.there.vertices, axis=1).max() == pytest.approx(0.6, abs=1e-6)


def test_the_picture_is_that_of_the_object_where_it_stands(library):
    case = case_of(library, position=0.0)
    picture, mask = case.picture(0.0)
    assert not mask.any() and library.look(picture, CAMERA).known == "box"
    turn = library.look(picture, CAMERA).pose.turn
    assert min(abs(turn - case.azimuth) % 180, 180 - abs(turn - case.azimuth) % 180) < 5
    half, mask = case.picture(0.6)
    assert (half[mask] == 128).all() and (half[~mask] == picture[~mask]).all()
    dark, _ = case.picture(0.0, light=0.05)
    assert dark.std() > 0 and (dark != picture).any()


def test_noise_grows_with_its_factor(library):
    quiet, loud = (
        [case_of(library, pose=pose, noise=factor, position=0.0).feel(40)[0] for pose in range(1)] for factor in (0, 5)
    )
    exact = replace(library.line(40), array=replace(library.sensor, travel_noise=0, relief_noise=0))
    assert quiet[0] == pytest.approx(exact.feel(case_of(library, position=0.0).surface)[0]) and loud[0] != quiet[0]


def test_spread_touches_are_far_apart_and_attention_goes_to_its_places(library):
    case = case_of(library)
    corner = primitives()["box"].vertices[[0]]
    case.places = {"glance": corner}
    belief = library.belief()
    for _ in range(3):
        line = case.next_line("spread", belief)
        belief = belief.after(library.line(line), *case.feel(line))
    contacts = np.array([touch.contact for touch in belief.touches])
    apart = np.linalg.norm(contacts[:, None] - contacts, axis=2)[np.triu_indices(3, 1)]
    assert apart.min() > 0.3
    line = case.next_line("glance", library.belief())
    travel, _ = case.feel(line)
    turn = np.radians(case.azimuth)
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    assert np.linalg.norm(library.line(line).contact(travel) - (corner @ rotation.T)[0]) < 0.12
    after = library.belief().after(library.line(line), travel, case.feel(line)[1])
    assert case.next_line("glance", after) != line


@pytest.mark.parametrize("policy", ["planned", "spread", "random", "glance"])
def test_each_way_names_the_object_after_some_touches(library, policy):
    case = case_of(library, "cone")
    case.places = {"glance": primitives()["cone"].vertices[::9]}
    course = touch_on(case, case.look("blind"), policy, 5)
    assert course.probabilities.shape == (6, 6) and policy in POLICIES
    assert course.probabilities[0] == pytest.approx(1 / 6) and course.probabilities[-1].argmax() == 3
    assert course.seconds > 0


def test_a_class_that_is_told_leaves_its_objects(library):
    belief = case_of(library).look("siblings", ["box", "cone"])
    assert np.flatnonzero(belief.values > 0.1).tolist() == [1, 3]
    told, not_told = (case_of(library).look(sight).values.max() for sight in ("look_told", "look"))
    assert told > 0.9 and not_told > 0.2
