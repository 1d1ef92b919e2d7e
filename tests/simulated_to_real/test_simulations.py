"""Objects that are laid on the array."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh
from stages.simulated_to_real import trial
from stages.simulated_to_real.trial import LARGE_PITCH, PITCH, SIMULATIONS, simulate

CELLS = (28, 50)


def mesh_of(solid):
    return Mesh(np.asarray(solid.vertices, dtype=np.float64), np.asarray(solid.faces, dtype=np.int64))


def test_an_object_lies_on_the_array_at_its_true_size(monkeypatch):
    brick = mesh_of(trimesh.creation.box((0.8, 0.4, 0.05)))  # 38 x 19 mm, flat: lies on its large sides
    monkeypatch.setattr(trial, "ASIDE", 0.0)
    found = simulate("resting", brick, 48, CELLS, 0.038, np.random.default_rng(0))
    assert found.shape == (48, *CELLS)
    cells = 38 * 19 / PITCH**2
    assert np.median((found > 0.5).sum(axis=(1, 2))) == pytest.approx(cells, rel=0.1)
    smaller = simulate("resting_small", brick, 48, CELLS, 0.038, np.random.default_rng(0))
    shrunk = cells * (PITCH / LARGE_PITCH) ** 2
    assert np.median((smaller > 0.5).sum(axis=(1, 2))) == pytest.approx(shrunk, rel=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("kind", SIMULATIONS)
def test_simulated_touches_are_pressures_and_the_same_in_every_run(kind):
    ball = mesh_of(trimesh.creation.icosphere(2, radius=0.5))
    found, again = (simulate(kind, ball, 4, CELLS, 0.04, np.random.default_rng(0)) for _ in range(2))
    assert np.array_equal(found, again) and found.min() >= 0 and found.max() <= 1
    assert (found.max(axis=(1, 2)) > 0.25).all() and found[:, 0, 0].max() < 0.5
