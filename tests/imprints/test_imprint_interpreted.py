"""The first imprints on a machine are interpreted: the same numbers as from compiled kernels, bit for bit."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from haptic_glance.base.jit import interpreted
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface
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


def test_the_tree_is_equal(monkeypatch):
    corners = np.random.default_rng(0).random((500, 3, 3))
    monkeypatch.setattr(faces.ORDER, "_left", 0)
    compiled = faces.face_tree(corners, np.ones(500))
    monkeypatch.setattr(faces, "ORDER", type("", (), {"for_work": lambda *_: interpreted(faces.order_faces)})())
    for here, there in zip(faces.face_tree(corners, np.ones(500)), compiled, strict=True):
        np.testing.assert_array_equal(here, there)
