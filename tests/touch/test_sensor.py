"""The sensors of the stage: each feels what its own function feels, and says where it cannot touch."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import CONTACTS, Surface, contour_imprints, distances, normalise
from haptic_glance.touch.quasi_tangent import CONTOURS, SENSORS, misfit, touch

CELLS, PITCH = (16, 16), 0.01


@pytest.fixture(scope="module")
def ball():
    made = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
    loose = [[2.0, 0, 0], [2.1, 0, 0], [2.2, 0, 0]]  # a face without area at the end
    return Mesh(np.r_[made.vertices, loose], np.r_[made.faces, [[len(made.vertices) + k for k in range(3)]]])


@pytest.mark.parametrize("contact", CONTACTS)
def test_the_array_feels_its_distances(ball, contact):
    felt = touch(Surface(ball), [0, 5], CELLS, PITCH, contact)
    expected = distances(ball, [0, 5], CELLS, PITCH, contact=contact)
    np.testing.assert_array_equal(felt.depths, expected)
    np.testing.assert_array_equal(felt.images, normalise(expected, PITCH))
    assert felt.depths.max() <= felt.reach


def test_the_contour_sensor_feels_contours(ball):
    felt = touch(Surface(ball), [0, 5], CELLS, PITCH, CONTOURS)
    np.testing.assert_array_equal(felt.images, contour_imprints(ball, [0, 5], CELLS, PITCH))
    assert felt.reach == 0.25 * 16 * PITCH and felt.depths.max() <= felt.reach


@pytest.mark.parametrize("sensor", SENSORS)
def test_where_a_sensor_cannot_touch_it_says_so(ball, sensor):
    felt = touch(Surface(ball), [0, len(ball.vertices) - 2, 5], CELLS, PITCH, sensor)
    assert felt.can.tolist() == [True, False, True] and len(felt.images) == len(felt.depths) == 2


def test_an_array_longer_than_the_object_is_named_with_the_remedy():
    assert misfit((16, 16), 0.01) == misfit((10, 5), 0.1) == ""
    assert "1.6 units long" in misfit((4, 16), 0.1) and "smaller pitch" in misfit((4, 16), 0.1)
