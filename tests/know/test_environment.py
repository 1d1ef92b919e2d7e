"""Touch until sure, as an environment of Gymnasium: its checker, its registration, rewards and ends."""

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium", reason="gymnasium is not installed")

from gymnasium.utils.env_checker import check_env  # noqa: E402

from haptic_glance.know import primitives  # noqa: E402
from haptic_glance.know.environment import REWARD, TouchUntilSure  # noqa: E402
from haptic_glance.mesh.mesh import Mesh  # noqa: E402


@pytest.fixture(scope="module")
def task():
    shapes = primitives()
    return TouchUntilSure({name: shapes[name] for name in ("box", "torus")}, most=4)


@pytest.mark.filterwarnings("error")
def test_gymnasium_finds_no_fault(task):
    check_env(task, skip_render_check=True)


def test_it_is_registered():
    assert isinstance(gymnasium.make("haptic_glance/TouchUntilSure-v0").unwrapped, TouchUntilSure)


@pytest.mark.filterwarnings("error")
def test_it_renders_the_last_imprint_in_the_mode_of_gymnasium():
    made = gymnasium.make("haptic_glance/TouchUntilSure-v0", render_mode="rgb_array")
    check_env(made.unwrapped)
    made.reset(seed=0)
    image = made.step(0)[0]["image"]
    picture = made.render()
    assert picture.shape == (256, 256, 3) and picture.dtype == np.uint8 and np.ptp(picture, axis=2).max() == 0
    assert np.abs(picture[8::16, 8::16, 0] / 255 - image).max() < 0.003 and np.ptp(image) > 0
    with pytest.raises(ValueError, match="human.*choose rgb_array"):
        TouchUntilSure(render_mode="human")
    with pytest.raises(gymnasium.error.ResetNeeded, match="call reset"):
        TouchUntilSure(render_mode="rgb_array").render()


def test_a_seed_decides_object_pose_and_places_and_no_pose_is_the_learned_one(task):
    first, info = task.reset(seed=1)
    again, same = task.reset(seed=1)
    learned, turned = task.meshes[info["name"]].vertices, task.exploration.surface.mesh.vertices
    assert not np.allclose(learned, turned)
    assert np.linalg.norm(learned, axis=1).max() == pytest.approx(np.linalg.norm(turned, axis=1).max())
    other, _ = task.reset(seed=2)
    assert info == same and all((first[name] == again[name]).all() for name in first)
    assert not np.allclose(first["normals"], other["normals"])


@pytest.mark.parametrize("belief", ["right", "wrong", "none"])
def test_an_episode_ends_with_a_name_or_after_its_touches(task, belief, monkeypatch):
    _, info = task.reset(seed=0, options={"name": "box"})
    assert info["name"] == "box"
    names = {"right": "box", "wrong": "torus", "none": ""}
    monkeypatch.setattr("haptic_glance.know.library.Belief.known", property(lambda self: names[belief]))
    rewards = {"right": REWARD - 1, "wrong": -REWARD - 1, "none": -1}
    for count in range(1, 5):
        observation, reward, sure, cut_off, info = task.step(task.planned())
        assert reward == rewards[belief] and sure == (belief != "none") and observation["touched"].sum() == count
        assert cut_off == (belief == "none" and count == 4) and info["known"] == names[belief]
        if sure:
            break
    with pytest.raises(gymnasium.error.ResetNeeded, match="call reset"):
        task.step(0)


def test_bad_input_is_named_and_changes_nothing(task):
    _, info = task.reset(seed=0)
    with pytest.raises(ValueError, match="unknown object 'sword': choose one of box, torus"):
        task.reset(options={"name": "sword"})
    for action in (-1, 64):
        with pytest.raises(ValueError, match="a place from 0 to 63"):
            task.step(action)
    assert task.step(0)[4]["name"] == info["name"]
    for most in (0, 1.5, np.nan):
        with pytest.raises(ValueError, match="a whole number of touches, at least one"):
            TouchUntilSure(most=most)
    for meshes, words in (([], "be a mapping"), ([*task.meshes.values()], "be a mapping"), ({1: 0}, "have texts")):
        with pytest.raises(TypeError, match=f"meshes must {words}"):
            TouchUntilSure(meshes)
    with pytest.raises(ValueError, match="unknown option 'nme'"):
        task.reset(options={"nme": "box"})


def test_meshes_of_any_size_are_normalised(task):
    large = {name: Mesh(5 * mesh.vertices, mesh.faces) for name, mesh in task.meshes.items()}
    other = TouchUntilSure(large)
    assert other.observation_space.contains(other.reset(seed=0)[0])


@pytest.mark.slow
def test_an_object_that_is_known_is_the_right_one():
    task, answers = TouchUntilSure(), []
    for seed in range(40):
        task.reset(seed=seed)
        while not task.ended:
            *_, info = task.step(task.planned())
        answers += [info["known"] == info["name"]] if info["known"] else []
    assert (
        len(answers) >= 8 and np.mean(answers) >= 0.8
    )  # three of ten are wrong with the belief that is right on average


def test_the_planner_touches_an_untouched_place_where_each_is_near_a_touched_one(task):
    task.reset(seed=0)
    task.exploration.positions = task.exploration.candidates.positions
    task.touched[:2] = 1
    assert task.planned() == 2
