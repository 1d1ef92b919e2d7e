"""Touch until sure, as an environment of Gymnasium: its checker, its registration, rewards and ends."""

from dataclasses import replace

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium", reason="gymnasium is not installed")

from gymnasium.utils.env_checker import check_env  # noqa: E402

from haptic_glance.know import PressureArray, primitives, stand  # noqa: E402
from haptic_glance.know.environment import REWARD, TouchUntilSure  # noqa: E402
from haptic_glance.know.library import AWAY  # noqa: E402
from haptic_glance.know.look_and_touch import BOARD, CAMERA, half_hidden  # noqa: E402
from haptic_glance.mesh.mesh import Mesh  # noqa: E402

NAMES = "box", "torus"


def shapes():
    return {name: primitives()[name] for name in NAMES}


@pytest.fixture(scope="module")
def task():
    return TouchUntilSure(shapes(), most=4)


@pytest.fixture(scope="module")
def blind():
    larger = {name: Mesh(2 * mesh.vertices, mesh.faces) for name, mesh in shapes().items()}
    return TouchUntilSure(larger, pose="fixed", sensor=PressureArray((4, 6), 0.02, 0.05), hidden=None)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", ["task", "blind"])
def test_gymnasium_finds_no_fault(name, request):
    check_env(request.getfixturevalue(name), skip_render_check=True)


@pytest.mark.slow
def test_it_is_registered_and_takes_any_pose():
    made = gymnasium.make("haptic_glance/TouchUntilSure-v0", meshes=shapes(), pose="any", hidden=None)
    made.reset(seed=0, options={"name": "box"})
    vertices = made.unwrapped.surface.mesh.vertices
    assert isinstance(made.unwrapped, TouchUntilSure) and np.ptp(vertices[:, 2]) > 0.5 + 0.1  # a box of height 0.38
    assert made.step(made.unwrapped.planned())[0]["touched"].sum() == 1


@pytest.mark.filterwarnings("error")
def test_it_renders_the_last_imprint_in_the_mode_of_gymnasium():
    made = gymnasium.make("haptic_glance/TouchUntilSure-v0", meshes=shapes(), render_mode="rgb_array").unwrapped
    check_env(made)
    before, _ = made.reset(seed=0, options={"name": "box"})
    imprint = made.step(int(before["directions"][:, 2].argmin()))[0]["imprint"]
    picture = made.render()
    assert picture.shape == (128, 128, 3) and picture.dtype == np.uint8 and np.ptp(picture, axis=2).max() == 0
    assert np.abs(picture[8::16, 8::16, 0] / 255 - imprint).max() < 0.003 and np.ptp(imprint) > 0
    with pytest.raises(ValueError, match="human.*choose rgb_array"):
        TouchUntilSure(shapes(), render_mode="human")
    with pytest.raises(gymnasium.error.ResetNeeded, match="call reset"):
        TouchUntilSure(shapes(), render_mode="rgb_array").render()


def test_a_seed_decides_object_azimuth_picture_and_lines(task):
    first, info = task.reset(seed=1)
    learned, turned = task.library.mesh(info["name"]).vertices, task.surface.mesh.vertices
    again, same = task.reset(seed=1)
    other, _ = task.reset(seed=2)
    assert info == same and all((first[name] == again[name]).all() for name in first)
    assert not np.allclose(learned, turned) and np.allclose(learned[:, 2], turned[:, 2])
    assert np.allclose(np.linalg.norm(learned, axis=1), np.linalg.norm(turned, axis=1))
    assert (first["origins"] != other["origins"]).any() and (first["picture"] != other["picture"]).any()
    assert len(set(task.lines.tolist())) == 64


def test_the_board_hides_the_share_and_the_belief_begins_with_the_look(task, blind):
    mesh = stand(task.library.mesh("torus"), 30)
    full, nothing = half_hidden(mesh, task.library.diameter, 0.0, np.random.default_rng(0))
    picture, mask = half_hidden(mesh, task.library.diameter, 0.6, np.random.default_rng(0))
    assert not nothing.any() and (picture[mask] == BOARD).all() and (picture[~mask] == full[~mask]).all()
    assert (mask & (full > 0)).sum() / (full > 0).sum() == pytest.approx(0.6, abs=0.02)
    look = task.library.look(picture, CAMERA, mask)
    assert look.probabilities["torus"] > 0.9
    first, _ = task.reset(seed=0, options={"name": "torus"})
    assert (first["picture"] == BOARD).mean() > 0.1 and first["belief"][NAMES.index("torus")] > 0.9
    unseen, _ = blind.reset(seed=0)
    assert not unseen["picture"].any() and unseen["belief"].tolist() == [0.5, 0.5]


def test_a_picture_cuts_off_an_object_larger_than_the_known_ones():
    ball = stand(primitives()["ball"])
    larger = replace(ball, vertices=1.3 * ball.vertices)
    shown, wider = (half_hidden(larger, size, 0.0, np.random.default_rng(0))[0] for size in (1.0, 2.0))
    assert (shown > 0).mean() > 0.95 and not shown[0, 0]  # but for the corners
    assert (wider > 0).sum() == pytest.approx(np.pi / 4 * (1.3 / 2 / 1.048 * 96) ** 2, rel=0.02)


def test_an_observation_tells_what_the_last_touch_felt_along_which_line(blind):
    before, _ = blind.reset(seed=3, options={"name": "box"})
    assert before["travel"] == np.float32(AWAY) and (before["imprint"] == 1).all() and not before["touched"].any()
    box, unit = blind.library.mesh("box"), blind.library.diameter
    assert np.allclose(blind.surface.mesh.vertices, box.vertices)
    action = int(before["directions"][:, 2].argmin())  # most from above
    after, *_ = blind.step(action)
    approach = blind.library.line(blind.lines[action])
    assert np.allclose(before["origins"][action] * unit, approach.origin)
    assert np.allclose(before["directions"][action], approach.direction)
    travel, imprint = approach.feel(box)  # this array has no noise
    assert after["travel"][0] == pytest.approx(travel / unit, abs=1e-5) and after["imprint"].shape == (4, 6)
    assert np.allclose(after["imprint"], imprint / 0.05, atol=1e-4)
    assert np.flatnonzero(after["touched"]).tolist() == [action]


def test_a_touch_that_meets_nothing_travels_away(blind, monkeypatch):
    blind.reset(seed=0)
    depth = blind.library.sensor.depth
    nothing = np.inf, np.full((4, 6), depth)
    monkeypatch.setattr("haptic_glance.know.pressure_array.Approach.feel", lambda *_: nothing)
    missed, *_ = blind.step(0)
    assert missed["travel"] == np.float32(AWAY) and (missed["imprint"] == 1).all()


@pytest.mark.parametrize("belief", ["right", "wrong", "none"])
def test_an_episode_ends_with_a_name_or_after_its_touches(task, belief, monkeypatch):
    _, info = task.reset(seed=0, options={"name": "box"})
    assert info["name"] == "box"
    names = {"right": "box", "wrong": "torus", "none": ""}
    monkeypatch.setattr("haptic_glance.know.belief.Belief.known", property(lambda self: names[belief]))
    rewards = {"right": REWARD - 1, "wrong": -REWARD - 1, "none": -1}
    for count in range(1, 5):
        observation, reward, sure, cut_off, info = task.step(task.planned())
        assert reward == rewards[belief] and sure == (belief != "none") and observation["touched"].sum() == count
        assert cut_off == (belief == "none" and count == 4) and info["known"] == names[belief]
        if sure:
            break
    with pytest.raises(gymnasium.error.ResetNeeded, match="call reset"):
        task.step(0)
    with pytest.raises(gymnasium.error.ResetNeeded, match="call reset"):
        task.planned()


def test_the_planner_takes_the_line_of_the_least_expected_entropy_that_was_not_followed(task, monkeypatch):
    task.reset(seed=0)
    expected = task.belief.expected_entropy(task.lines)
    assert task.planned() == expected.argmin()
    entropies = np.arange(64.0)
    monkeypatch.setattr("haptic_glance.know.belief.Belief.expected_entropy", lambda *_: entropies)
    task.touched[:2] = 1
    assert task.planned() == 2
    task.touched[:] = 1
    assert task.planned() == 0


def test_bad_input_is_named_and_changes_nothing(task):
    _, info = task.reset(seed=0)
    with pytest.raises(ValueError, match="unknown object 'sword': choose one of box, torus"):
        task.reset(options={"name": "sword"})
    for action in (-1, 64):
        with pytest.raises(ValueError, match="a line from 0 to 63"):
            task.step(action)
    assert task.step(0)[4]["name"] == info["name"]
    for most in (0, 1.5, np.nan):
        with pytest.raises(ValueError, match="a whole number of touches, at least one"):
            TouchUntilSure(most=most)
    for hidden in (-0.1, 0.96, np.nan):
        with pytest.raises(ValueError, match=r"hidden is a share from 0 to 0.95, or None for no picture"):
            TouchUntilSure(hidden=hidden)
    for meshes, words in (([], "be a mapping"), ([*shapes().values()], "be a mapping"), ({1: 0}, "have texts")):
        with pytest.raises(TypeError, match=f"meshes must {words}"):
            TouchUntilSure(meshes)
    with pytest.raises(ValueError, match="with one object there is nothing to find out: give two or more"):
        TouchUntilSure({"box": primitives()["box"]})
    with pytest.raises(ValueError, match="unknown option 'nme'"):
        task.reset(options={"nme": "box"})
