"""Cluster-based saliency (Tasse 2015) on shapes whose odd parts are known, and its descriptor on known normals."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from haptic_glance.look.kernels import fpfh
from haptic_glance.look.rivals import tasse
from haptic_glance.mesh.mesh import Mesh

PAIR, EACH_OTHER, STARTS = np.array([[0.0, 0, 0], [2, 0, 0]]), np.array([1, 0]), np.array([0, 1, 2])


@pytest.mark.parametrize(
    ("normals", "bins"),
    [
        ([[0, 0, 1], [0, 0, 1]], (5, 5, 5)),  # a plane: all angles are zero
        ([[0, 0, 1], [0, 1, 0]], (5, 0, 5)),  # turned by 90 degrees about the line: v is the other normal, reversed
        ([[0, 0, 1], [0.6, 0, 0.8]], (6, 5, 2)),  # a hollow: the second lies nearer to the line, -0.6 along it
        ([[0, 0, 1], [-0.6, 0, 0.8]], (4, 5, 8)),  # a ridge: the same, reversed
    ],
)
def test_the_descriptor_counts_the_angles_of_a_pair(normals, bins):
    found = fpfh(PAIR, np.array(normals, dtype=float), EACH_OTHER, STARTS)
    assert [list(part.nonzero()[0]) for part in found[0].reshape(3, 11)] == [[k] for k in bins]
    assert np.array_equal(found[0], found[1]) and found.sum() == 6


def test_a_zero_normal_has_no_descriptor():
    assert not fpfh(PAIR, np.array([[0.0, 0, 0], [0, 0, 1]]), EACH_OTHER, STARTS).any()


@pytest.fixture(scope="module")
def ball(raised):
    return raised([[1, 0, 0]], [0.15], [0.3], subdivisions=4)


@pytest.mark.slow
def test_a_turned_and_scaled_mesh_keeps_its_map(ball, saliency_of):
    """But for ties between clusters."""
    turn = Rotation.from_euler("xyz", [20, 30, 50], degrees=True).as_matrix()
    turned = Mesh(1e5 * (ball.vertices @ turn.T + [3, -2, 1]), ball.faces)
    assert np.corrcoef(tasse.saliency(turned), saliency_of(tasse, ball))[0, 1] > 0.99


@pytest.mark.slow
def test_a_bump_is_salient_and_the_ball_under_it_is_not(ball, saliency_of):
    values = saliency_of(tasse, ball)
    on_it = ball.vertices[:, 0] / np.linalg.norm(ball.vertices, axis=1) > np.cos(0.15)
    assert values[on_it].mean() > 0.3 and values[ball.vertices[:, 0] < 0].max() < 0.05
    assert on_it[tasse.points(ball, values)[0]]


@pytest.mark.slow
def test_a_rare_shape_is_more_salient_than_a_common_one(sphere):
    """One small ball among four large ones."""
    large, small = sphere(3), sphere(3, 0.2)
    places = np.array([[-6.0, -6, 0], [-6, 6, 0], [6, -6, 0], [6, 6, 0]])
    vertices = np.concatenate([*(large.vertices + place for place in places), small.vertices])
    faces = np.concatenate([large.faces + k * len(large.vertices) for k in range(5)])
    values = tasse.saliency(Mesh(vertices, faces)).reshape(5, -1)
    assert values[4].min() > 2 * values[:4].max()
