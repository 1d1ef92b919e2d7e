"""3D-SIFT (Godil 2011) on shapes whose keypoints are known."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation
from scipy.special import erf

from stages.kit import Mesh
from stages.salient_points.rivals import sift
from stages.salient_points.rivals.sift import points, saliency

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


def test_a_bump_of_the_right_size_is_the_only_point_and_a_wide_swell_has_no_saliency(bumpy, values):
    found = points(bumpy, values)
    assert len(found) == 1
    assert np.linalg.norm(bumpy.vertices[found[0]] - 1.06 * X) < 0.05
    assert values[np.argmin(BALL.vertices @ X)] == 0


def test_a_bump_below_a_voxel_has_no_saliency():
    assert saliency(ball_with((BALL.vertices[1], 0.01, 0.013))).max() == 0


def test_a_small_ball_is_a_keypoint_of_its_own_size():
    """The difference of Gaussians answers a ball of radius r most at its centre, at sigma = r / sqrt(3)."""
    large, small = Mesh(BALL.vertices, BALL.faces), 0.12 * SMALL.vertices + [0, 0, 1.5]
    mesh = Mesh(np.r_[large.vertices, small], np.r_[large.faces, SMALL.faces + len(large.vertices)])
    values = saliency(mesh)
    assert values.argmax() >= len(large.vertices)
    keypoint = sift._keypoints(mesh)
    best = keypoint.responses.argmax()
    np.testing.assert_allclose(keypoint.positions[best], [0, 0, 1.5], atol=0.03)
    ratio = keypoint.sigmas[best] * 2 ** (1 / 6) * np.sqrt(3) / 0.12  # the middle of the two Gaussians
    assert 2 ** (-1 / 3) < ratio < 2 ** (1 / 3)


def test_the_scale_space_is_that_of_the_solid_ball():
    """At the centre of a ball a Gaussian sees erf(u) - 2 u exp(-u^2) / sqrt(pi) of it, u = radius / (sqrt(2) sigma)."""
    mesh = Mesh(BALL.vertices * 0.1, BALL.faces)
    speck = [[1, 0, 0], [1, 1e-4, 0], [1, 0, 1e-4]]  # makes the ball small in the grid
    mesh = Mesh(np.r_[mesh.vertices, speck], np.r_[mesh.faces, [len(mesh.vertices) + np.arange(3)]])
    origin, step, dogs = sift._scale_space(mesh)
    voxel = np.round(-origin / step).astype(int)
    u = 0.1 / step / (np.sqrt(2) * sift.SIGMA * 2 ** (np.arange(len(dogs) + 1) / sift.INTERVALS))
    held = erf(u) - 2 * u * np.exp(-(u**2)) / np.sqrt(np.pi)
    np.testing.assert_allclose([dog[tuple(voxel)] for dog in dogs], np.diff(held), atol=0.01)


def test_a_dent_counts_like_a_bump_and_a_hole_elsewhere_does_not_matter():
    dent = ball_with((X, -0.06, 0.08))
    bump = ball_with((X, 0.06, 0.08))
    open_ = Mesh(bump.vertices, bump.faces[(bump.vertices[bump.faces][:, :, 0] > -0.8).all(axis=1)])
    for mesh in dent, open_:
        assert np.linalg.norm(mesh.vertices[points(mesh)[0]] - X) < 0.15


def test_size_and_order_of_vertices_do_not_matter(bumpy, values):
    order = np.random.default_rng(0).permutation(len(bumpy.vertices))
    other = Mesh(7 * bumpy.vertices[order], np.argsort(order)[bumpy.faces])
    moved = saliency(other)
    np.testing.assert_allclose(moved, values[order], atol=1e-9)
    np.testing.assert_array_equal(order[points(other, moved)], points(bumpy, values))


def test_a_turned_mesh_keeps_its_map_and_first_point_within_a_voxel(bumpy, values):
    turn = Rotation.from_euler("xyz", [20, 30, 50], degrees=True).as_matrix()
    turned = Mesh(bumpy.vertices @ turn.T, bumpy.faces)
    moved = saliency(turned)
    assert np.corrcoef(moved, values)[0, 1] > 0.95
    first = bumpy.vertices[[points(turned, moved)[0], points(bumpy, values)[0]]]
    assert np.linalg.norm(first[0] - first[1]) < 0.05


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
