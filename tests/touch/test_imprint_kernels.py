"""The kernels of touch: interpreted they give the numbers of compiled ones, and their tree holds each face once."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from haptic_glance.base.jit import interpreted
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface
from haptic_glance.touch.kernels import faces, measure
from haptic_glance.touch.kernels.faces import face_tree

CELLS = (5, 7)

SHAPES = {
    "cube": trimesh.creation.box((0.5, 0.5, 0.5)),
    "open tube": trimesh.creation.revolve([[0.3, -0.3], [0.3, 0.3]], sections=40),
}


KERNELS = [(measure.measure, (False,)), (measure.measure, (True,)), (measure.first_below, (0.1,))]


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize(("kernel", "more"), KERNELS)
def test_distances_are_equal_bit_for_bit(name, kernel, more):
    mesh, random = Mesh(SHAPES[name].vertices, SHAPES[name].faces), np.random.default_rng(0)
    tree = Surface(mesh)._tree
    axes = Rotation.random(6, random_state=0).as_matrix()
    centres = mesh.vertices[random.integers(0, len(mesh.vertices), 6)] + random.normal(0, 0.02, (6, 3))
    arguments = *tree, mesh.diagonal, 1e-9, CELLS, centres, axes, np.array([0.01, 0.02, 0.05] * 2), *more
    compiled = kernel(*arguments)
    assert np.isfinite(compiled).any() and (compiled != compiled.flat[0]).any()
    np.testing.assert_array_equal(interpreted(kernel)(*arguments), compiled)


def test_presses_are_equal_bit_for_bit():
    mesh, random = Mesh(SHAPES["open tube"].vertices, SHAPES["open tube"].faces), np.random.default_rng(0)
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


def test_the_tree_is_equal(monkeypatch):
    corners = np.random.default_rng(0).random((500, 3, 3))
    monkeypatch.setattr(faces.ORDER, "_left", 0)
    compiled = faces.face_tree(corners, np.ones(500))
    monkeypatch.setattr(faces, "ORDER", type("", (), {"for_work": lambda *_: interpreted(faces.order_faces)})())
    for part, expected in zip(faces.face_tree(corners, np.ones(500)), compiled, strict=True):
        np.testing.assert_array_equal(part, expected)


LANES = 32


def corners_of(count):
    """(count, 3, 3) corners of faces, many of them at one place along an axis."""
    return np.random.default_rng(count).integers(0, 9, (count, 3, 3)).astype(float)


@pytest.mark.parametrize("count", [0, 1, 32, 33, 1000])
def test_each_face_is_in_one_block_and_only_the_last_block_is_filled_up(count):
    corners = corners_of(count)
    blocks = face_tree(corners, np.arange(count) + 1.0)[0]
    faces = blocks.reshape(-1, 10, LANES).transpose(0, 2, 1).reshape(-1, 10)
    assert np.isnan(faces[count:]).all() and len(faces) - count < LANES
    order = np.argsort(faces[:count, 9])
    np.testing.assert_array_equal(faces[:count][order, :9].reshape(-1, 3, 3), corners)


@pytest.mark.parametrize("count", [33, 1000])
def test_the_box_of_a_node_just_holds_the_faces_below_it(count):
    blocks, boxes, children = face_tree(corners_of(count), np.ones(count))

    def places(node):
        """(p, 3) the corners below a node."""
        if children[node] < 0:
            corners = blocks[-1 - children[node], : 9 * LANES].reshape(3, 3, LANES).transpose(2, 0, 1).reshape(-1, 3)
            return corners[~np.isnan(corners[:, 0])]
        return np.concatenate([places(children[node]), places(children[node] + 1)])

    assert len(places(0)) == 3 * count
    for node, box in enumerate(boxes):
        low, high = places(node).min(axis=0), places(node).max(axis=0)
        np.testing.assert_allclose(box, np.concatenate([(low + high) / 2, (high - low) / 2]))


def test_a_node_is_split_across_the_longest_side_of_the_centres():
    corners = corners_of(640) * [1, 1, 5]
    blocks, _, children = face_tree(corners, np.ones(640))
    first = -1 - np.array(children[children < 0])
    assert sorted(first) == list(range(20))
    heights = blocks[:, : 9 * LANES].reshape(20, 3, 3, LANES)[:, :, 2].mean(axis=1)
    assert heights[:10].max() <= heights[10:].min()
