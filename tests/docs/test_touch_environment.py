"""The environment of the tutorial on touch: with gymnasium one of its own, without it the same physics."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh

pytest.importorskip("matplotlib")
TUTORIAL = Path(__file__).parents[2] / "docs" / "tutorials" / "touch_environment.py"


def module():
    spec = importlib.util.spec_from_file_location("touch_environment", TUTORIAL)
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


def made(tutorial):
    ball = trimesh.creation.icosphere(4, radius=0.05)
    return tutorial.TouchEnvironment(Mesh(ball.vertices, ball.faces))


@pytest.fixture(params=["as installed", "without gymnasium"])
def environment(request, monkeypatch):
    if request.param == "without gymnasium":
        monkeypatch.setitem(sys.modules, "gymnasium", None)
    return made(module())


def test_the_environment_is_one_of_gymnasiums():
    pytest.importorskip("gymnasium", reason="gymnasium is not installed, which the tutorial shows")
    from gymnasium.utils.env_checker import check_env

    check_env(made(module()), skip_render_check=True)


def test_the_sensor_feels_more_the_deeper_it_goes_and_stops_at_its_backing(environment):
    felt, _ = environment.reset(seed=0)
    loads = [environment.step([0, 0, -0.25])[4]["load"] for _ in range(8)]
    assert felt.sum() < 0.01 and (np.diff(loads[:4]) > 0).all()
    assert loads[0] == pytest.approx(np.pi * environment.layer.stiffness * 0.05 * 0.0005**2, rel=0.1)
    assert loads[4:] == pytest.approx([loads[3]] * 4)


def test_a_sensor_that_is_lifted_feels_nothing_and_far_away_the_episode_ends(environment):
    environment.reset(seed=1)
    felt, reward, over, _, _ = environment.step([0, 0, 1])
    assert not felt.any() and reward == -1 and not over
    assert any(environment.step([0, 0, 1])[2] for _ in range(30))
