"""Points on a surface: as many on each face as its area asks for, uniform within it."""

import numpy as np
import pytest

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.sampling import points_in_faces, sample_surface

CORNERS = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 1], [5, 5, 5]], dtype=float)
MESH = Mesh(CORNERS, [[0, 1, 2], [0, 2, 3], [0, 3, 1]])  # areas 2, 1, 1


def sampled(count, areas=None):
    random = np.random.default_rng(0)
    return sample_surface(MESH, (np.arange(count) + random.random(count)) / count, random.random((2, count)), areas)


@pytest.mark.slow
def test_each_face_gets_its_share_of_the_points_to_within_one():
    _, faces, _ = sampled(1001)
    assert np.abs(np.bincount(faces) - 1001 * np.array([0.5, 0.25, 0.25])).max() < 1
    _, faces, _ = sampled(1000, areas=np.array([0.0, 3.0, 1.0]))
    assert np.bincount(faces).tolist() == [0, 750, 250]


def test_points_are_the_weighted_corners_of_their_faces():
    points, faces, weights = sampled(500)
    assert (weights >= 0).all() and weights.sum(axis=1) == pytest.approx(1)
    assert points == pytest.approx(np.einsum("ki,kij->kj", weights, CORNERS[MESH.faces[faces]]))


def test_points_are_uniform_within_a_face():
    draws = np.stack([grid.ravel() for grid in np.meshgrid(*2 * [(np.arange(200) + 0.5) / 200], indexing="ij")])
    points, _ = points_in_faces(MESH, np.zeros(len(draws[0]), dtype=np.int64), draws)
    assert points.mean(axis=0) == pytest.approx([2 / 3, 2 / 3, 0], abs=1e-4)  # the centroid
    assert (points[:, :2].sum(axis=1) < 1).mean() == pytest.approx(0.25, abs=0.01)  # a quarter of the area


def test_the_ends_of_the_surface_are_on_its_first_and_last_face():
    _, faces, _ = sample_surface(MESH, np.array([0.0, 1.0]), np.full((2, 2), 0.5))
    assert faces.tolist() == [0, 2]


@pytest.mark.parametrize("mesh", [Mesh(CORNERS, [[0, 0, 1]]), Mesh(CORNERS, np.zeros((0, 3), dtype=int))])
def test_a_mesh_without_area_is_refused(mesh):
    with pytest.raises(ValueError, match="without area"):
        sample_surface(mesh, np.array([0.5]), np.full((2, 1), 0.5))
