"""Differences between pictures of one object: errors, and the density of points and faces."""

import numpy as np
import pytest

from haptic_glance.mesh.mesh import Mesh
from stages.lod import level_pictures as pictures
from stages.lod.level_pictures import against_the_mean, density, faces_an_area


def test_colours_of_the_error_are_those_of_the_distance(small):
    inner = small.ball()
    inner = type(inner)(0.9 * inner.vertices, inner.faces)
    distances = pictures.errors(small.ball(24), inner)
    assert distances.mean() == pytest.approx(0.05 / np.sqrt(3), rel=0.1)


@pytest.fixture
def mesh(small):
    return small.ball(16)


def ends(mesh):
    """The vertices at the two poles."""
    return int(mesh.vertices[:, 2].argmax()), int(mesh.vertices[:, 2].argmin())


def test_points_lie_dense_where_they_are_and_their_number_does_not_matter(mesh):
    top, bottom = ends(mesh)
    densities = density(mesh, np.array([top]))
    assert densities.argmax() == top and densities[bottom] == 0 and densities.mean() == pytest.approx(1)
    assert density(mesh, np.array([top, top])) == pytest.approx(densities)
    assert not density(mesh, np.array([], dtype=int)).any()


def test_a_method_has_more_where_the_others_have_fewer(mesh):
    top, bottom = ends(mesh)
    points = {"up": np.array([top]), "down": np.array([bottom]), "none": np.array([], dtype=int)}
    shares = against_the_mean(mesh, points)
    assert set(shares) == {"up", "down"}
    assert shares["up"][top] > 0.9 and shares["up"][bottom] < 0.1 and shares["down"] == pytest.approx(1 - shares["up"])
    assert shares["up"][np.abs(mesh.vertices[:, 2]) < 0.01] == pytest.approx(0.5)


def test_faces_lie_dense_where_they_are_small():
    vertices = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [-1, 0, 0], [0, -1, 0], [-1, -1, 0.0]])
    densities = faces_an_area(Mesh(vertices, np.array([[0, 1, 2], [0, 3, 4], [3, 5, 4]])))
    assert densities[1] < 0.5 < densities[5]
