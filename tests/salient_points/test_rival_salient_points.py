"""Salient points (Castellani 2008) on shapes whose salient places are known."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from stages.kit import Mesh
from stages.salient_points.rivals.salient_points import points, saliency

X = np.array([1.0, 0, 0])
BALL = trimesh.creation.icosphere(subdivisions=5)


def ball_with(*bumps):
    """The unit ball raised round each (direction, height, width), by height * exp(-angle^2 / (2 width^2))."""
    angles = [np.arccos(np.clip(BALL.vertices @ direction, -1, 1)) for direction, _, _ in bumps]
    radius = 1 + sum(h * np.exp(-(a**2) / (2 * w**2)) for a, (_, h, w) in zip(angles, bumps, strict=True))
    return Mesh(BALL.vertices * radius[:, None], BALL.faces)


@pytest.fixture(scope="module")
def bumpy():
    """A bump of 2 % of the diagonal at +x and a swell of 14 % at -x."""
    return ball_with((X, 0.06, 0.08), (-X, 0.12, 0.5))


@pytest.fixture(scope="module")
def values(bumpy):
    return saliency(bumpy)


def test_a_sphere_and_a_plane_have_neither_saliency_nor_points():
    ball = trimesh.creation.icosphere(subdivisions=4)
    sheet = trimesh.creation.box().subdivide().subdivide().subdivide()
    for mesh in Mesh(ball.vertices, ball.faces), Mesh(sheet.vertices, sheet.faces[sheet.face_normals[:, 2] > 0.5]):
        values = saliency(mesh)
        assert values.max() == 0
        assert len(points(mesh, values)) == 0


def test_values_lie_in_0_to_1_one_a_vertex(bumpy, values):
    assert values.shape == (len(bumpy.vertices),)
    assert values.min() >= 0
    assert values.max() <= 1 + 1e-12


def test_a_bump_of_the_right_size_is_the_first_point_and_a_wide_swell_is_none(bumpy, values):
    found = points(bumpy, values)
    top, swell = np.argmax(BALL.vertices @ X), np.argmin(BALL.vertices @ X)
    assert found[0] == top
    assert values[swell] < 0.3 * values[top]
    assert swell not in found


def test_a_bump_far_below_the_scales_counts_less_than_one_of_the_right_size():
    """The small bump, one vertex wide, is as steep as the other."""
    fine = np.array([0.0, 1, 0]) if (BALL.vertices == [0, 1, 0]).all(axis=1).any() else BALL.vertices[1]
    values = saliency(ball_with((X, 0.06, 0.08), (fine, 0.01, 0.013)))
    assert values[np.argmax(BALL.vertices @ fine)] < 0.5 * values[np.argmax(BALL.vertices @ X)]


def test_the_ends_of_an_ellipsoid_come_first():
    ellipsoid = Mesh(BALL.vertices * [1, 0.3, 0.3], BALL.faces)
    np.testing.assert_allclose(np.abs(ellipsoid.vertices[points(ellipsoid)[:2]]), [X, X], atol=0.02)


def test_the_corners_of_a_cube_come_first():
    box = trimesh.creation.box()
    for _ in range(4):
        box = box.subdivide()
    cube = Mesh(box.vertices, box.faces)
    corners = np.abs(cube.vertices[points(cube)[:8]])
    np.testing.assert_allclose(corners, 0.5)


def test_points_exceed_three_tenths_of_the_maximum():
    mesh = ball_with((X, 0.06, 0.08), (np.array([0, 1.0, 0]), 0.006, 0.08), (np.array([0, 0, 1.0]), 0.04, 0.08))
    values = saliency(mesh)
    found = points(mesh, values)
    assert len(found) == 2
    assert values[found].min() > 0.3


def test_size_and_order_of_vertices_do_not_matter(bumpy, values):
    order = np.random.default_rng(0).permutation(len(bumpy.vertices))
    other = Mesh(7 * bumpy.vertices[order], np.argsort(order)[bumpy.faces])
    moved = saliency(other)
    np.testing.assert_allclose(moved, values[order], atol=1e-9)
    np.testing.assert_array_equal(order[points(other, moved)], points(bumpy, values))


def test_a_turned_mesh_keeps_its_map_and_first_point(bumpy, values):
    turn = Rotation.from_euler("xyz", [20, 30, 50], degrees=True).as_matrix()
    turned = Mesh(bumpy.vertices @ turn.T, bumpy.faces)
    moved = saliency(turned)
    np.testing.assert_allclose(moved, values, atol=0.05)
    assert points(turned, moved)[0] == points(bumpy, values)[0]


TRIANGLE = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
SMALL = trimesh.creation.icosphere(subdivisions=2)
BAD = {
    "no face": Mesh(np.eye(3), np.zeros((0, 3), dtype=int)),
    "no vertex": Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int)),
    "one place": Mesh(np.zeros((3, 3)), [[0, 1, 2]]),
    "one triangle": TRIANGLE,
    "a line": Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]]),
    "far pieces": Mesh(np.r_[SMALL.vertices, SMALL.vertices + 1000], np.r_[SMALL.faces, SMALL.faces + 162]),
    "inward": Mesh(SMALL.vertices * [1, 0.3, 0.3], SMALL.faces[:, ::-1]),
    "loose vertex": Mesh(np.r_[SMALL.vertices * [1, 0.3, 0.3], [[0, 0, 2]]], SMALL.faces),
    "coincident": Mesh(SMALL.vertices[SMALL.faces].reshape(-1, 3), np.arange(3 * len(SMALL.faces)).reshape(-1, 3)),
}


def test_values_at_hand_give_the_same_points():
    mesh = BAD["loose vertex"]
    np.testing.assert_array_equal(points(mesh, saliency(mesh)), points(mesh))


@pytest.mark.parametrize("name", BAD)
def test_bad_meshes_give_finite_values_and_points_on_the_surface(name):
    mesh = BAD[name]
    values = saliency(mesh)
    found = points(mesh, values)
    assert values.shape == (len(mesh.vertices),)
    assert np.isfinite(values).all()
    assert (values >= 0).all()
    assert found.dtype == np.int64
    assert np.isin(found, mesh.faces).all()
