"""The first imprints on a machine are interpreted: the same numbers as from compiled kernels, bit for bit."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from haptic_glance.base.jit import interpreted
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Layout, Surface
from haptic_glance.touch.kernels import faces, measure

CELLS = (5, 7)


SHAPES = {
    "sphere": trimesh.creation.icosphere(3, 0.5),
    "cube": trimesh.creation.box((0.5, 0.5, 0.5)),
    "open tube": trimesh.creation.revolve([[0.3, -0.3], [0.3, 0.3]], sections=40),
    "torus": trimesh.creation.torus(0.35, 0.15),
}


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize(("kernel", "more"), [(measure.measure, ()), (measure.first_below, (0.1,))])
def test_distances_are_equal_bit_for_bit(name, kernel, more):
    mesh, random = Mesh(SHAPES[name].vertices, SHAPES[name].faces), np.random.default_rng(0)
    tree = Surface(mesh)._tree
    axes = Rotation.random(6, random_state=0).as_matrix()
    centres = mesh.vertices[random.integers(0, len(mesh.vertices), 6)] + random.normal(0, 0.02, (6, 3))
    arguments = *tree, mesh.diagonal, 1e-9, CELLS, centres, axes, np.array([0.01, 0.02, 0.05] * 2), *more
    compiled = kernel(*arguments)
    assert np.isfinite(compiled).any() and (compiled != compiled.flat[0]).any()
    np.testing.assert_array_equal(interpreted(kernel)(*arguments), compiled)


@pytest.mark.parametrize("name", SHAPES)
def test_presses_are_equal_bit_for_bit(name):
    mesh, random = Mesh(SHAPES[name].vertices, SHAPES[name].faces), np.random.default_rng(0)
    axes = Rotation.random(4, random_state=0).as_matrix()
    tree = *Surface(mesh)._tree, mesh.diagonal, 1e-9
    places = mesh.vertices[random.integers(0, len(mesh.vertices), 4)], axes
    for loads in (np.empty(0), np.array([1e-3, 0.1, 1.0, -1.0])):
        pressed = [
            (work(*tree, CELLS, *places, 0.03, 1.0, 7.0, 0.2, loads, depths), depths)
            for work in (measure.press, interpreted(measure.press))
            for depths in [np.array([0.0, 0.01, 0.1, np.nan])]
        ]
        for compiled, plain in zip(*pressed, strict=True):
            assert compiled[:3].any() and np.isnan(pressed[0][1][3])
            np.testing.assert_array_equal(compiled[:3], plain[:3])
    x, y, z = random.uniform(-0.1, 0.1, (3, 30))
    cells, pitch, _, grid = Layout(np.c_[x, y, z], np.tile([0, 0, -1.0], (30, 1)), np.ones(30)).cells
    arguments = *tree, cells, *places, pitch, np.array([0, 0, 0.3]), 0.1, grid, 30
    below = measure.below_taxels(*arguments)
    assert np.isfinite(below).any()
    np.testing.assert_array_equal(interpreted(measure.below_taxels)(*arguments), below)


def test_the_tree_is_equal(monkeypatch):
    corners = np.random.default_rng(0).random((500, 3, 3))
    monkeypatch.setattr(faces.ORDER, "_left", 0)
    compiled = faces.face_tree(corners, np.ones(500))
    monkeypatch.setattr(faces, "ORDER", type("", (), {"for_work": lambda *_: interpreted(faces.order_faces)})())
    for here, there in zip(faces.face_tree(corners, np.ones(500)), compiled, strict=True):
        np.testing.assert_array_equal(here, there)
