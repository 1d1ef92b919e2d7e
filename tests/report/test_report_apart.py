"""What makes pictures of one object differ."""

import numpy as np
import pytest

from haptic_glance.mesh.mesh import Mesh
from stages.report.meshes.pictures import against_the_mean, density, faces_an_area


@pytest.fixture
def mesh(small):
    return small.ball(16)


def ends(mesh):
    """The vertices at the two poles."""
    return int(mesh.vertices[:, 2].argmax()), int(mesh.vertices[:, 2].argmin())


def test_points_lie_dense_where_they_are_and_their_number_does_not_matter(mesh):
    top, bottom = ends(mesh)
    found = density(mesh, np.array([top]))
    assert found.argmax() == top and found[bottom] == 0 and found.mean() == pytest.approx(1)
    assert density(mesh, np.array([top, top])) == pytest.approx(found)
    assert not density(mesh, np.array([], dtype=int)).any()


def test_a_method_has_more_where_the_others_have_fewer(mesh):
    top, bottom = ends(mesh)
    points = {"up": np.array([top]), "down": np.array([bottom]), "none": np.array([], dtype=int)}
    found = against_the_mean(mesh, points)
    assert set(found) == {"up", "down"}
    assert found["up"][top] > 0.9 and found["up"][bottom] < 0.1 and found["down"] == pytest.approx(1 - found["up"])
    assert found["up"][np.abs(mesh.vertices[:, 2]) < 0.01] == pytest.approx(0.5)


def test_equal_points_differ_nowhere(mesh):
    same = np.array(ends(mesh))
    assert all(values == pytest.approx(0.5) for values in against_the_mean(mesh, {"a": same, "b": same}).values())


def test_faces_lie_dense_where_they_are_small():
    vertices = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [-1, 0, 0], [0, -1, 0], [-1, -1, 0.0]])
    found = faces_an_area(Mesh(vertices, np.array([[0, 1, 2], [0, 3, 4], [3, 5, 4]])))
    assert found[1] < 0.5 < found[5]
