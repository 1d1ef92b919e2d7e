"""Two senses of one object, and a network that trusts one of them."""

import numpy as np
import pytest

from haptic_glance.know import place_at, primitives
from haptic_glance.studio.panels.senses import CELLS, SIZE, Answer, ask, load_network, newest_network, sense, viewpoint
from haptic_glance.touch import Surface

pytestmark = pytest.mark.slow

torch = pytest.importorskip("torch", reason="the hybrid network needs torch: pip install 'haptic-glance[deep]'")


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    """An untrained network, in a file as the stage writes it."""
    from haptic_glance.deep.hybrid import HybridNet, save
    from haptic_glance.deep.network import build

    folder = tmp_path_factory.mktemp("root")
    path = folder / "data" / "furniture" / "transfer" / "hybrid" / "networks" / "hybrid.npz"
    path.parent.mkdir(parents=True)
    network = build("mobilenet_v2", 3, "random", 0)
    save(path, HybridNet(network, network), ["chair", "sofa", "table"])
    assert newest_network(folder) == path
    return load_network(path)


@pytest.fixture(scope="module")
def sensed():
    mesh = primitives()["cone"]
    surface = Surface(mesh)
    place = place_at(surface, mesh.vertices[mesh.faces[:1]].mean(axis=1), np.array([0]))
    return sense(mesh, surface, viewpoint(np.array([1.0, -1.0, 0.5]), np.zeros(3)), place)


def test_there_may_be_no_network(tmp_path):
    assert newest_network(tmp_path) is None


def test_the_camera_becomes_a_viewpoint_that_the_network_knows():
    seen = viewpoint(np.array([0.0, 2.0, 1.0]), np.array([0.0, 0.0, 1.0]))
    assert (seen.azimuth, seen.elevation) == (pytest.approx(90), pytest.approx(0))
    assert viewpoint(np.array([0.1, 0.0, 3.0]), np.zeros(3)).elevation == 60
    assert viewpoint(np.array([1.0, 0.0, -3.0]), np.zeros(3)).elevation == -10


def test_both_senses_are_asked_and_the_surer_is_trusted(trained, sensed):
    picture, imprint = sensed
    assert picture.shape == (SIZE, SIZE, 3) and imprint.shape == (CELLS, CELLS) and np.ptp(picture) > 50
    answer = ask(trained, picture, imprint, 0.0, 0.0)
    assert isinstance(answer, Answer) and set(answer.vision) == set(answer.touch) == {"chair", "sofa", "table"}
    assert sum(answer.vision.values()) == pytest.approx(1, abs=1e-5)
    surer = "vision" if max(answer.vision.values()) >= max(answer.touch.values()) else "touch"
    assert answer.sense == surer


@pytest.mark.parametrize(("dark", "dead", "trusted"), [(1.0, 0.0, "touch"), (0.0, 1.0, "vision"), (1.0, 1.0, "")])
def test_a_sense_that_is_dark_or_dead_is_not_trusted(trained, sensed, dark, dead, trusted):
    answer = ask(trained, *sensed, dark, dead)
    assert answer.sense == trusted
    assert (answer.vision == {}) == (dark == 1) and (answer.touch == {}) == (dead == 1)
