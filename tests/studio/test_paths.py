"""Paths of the array over an object."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.studio.panels.path import around, through
from haptic_glance.studio.specimen import Specimen
from haptic_glance.touch import Surface, follow

SHEETS = (-0.5, 0.0, -0.15), (-0.5, 0.5, 0.15)  # from x, to x, at y
EYE = np.array([0.0, -3.0, 0.0])


@pytest.fixture(scope="module")
def ball():
    shape = trimesh.creation.icosphere(subdivisions=4)
    return Specimen(Mesh(np.asarray(shape.vertices), np.asarray(shape.faces)), "ball")


@pytest.fixture(scope="module")
def pair():
    """Two balls with a gap between them."""
    shapes = [trimesh.creation.icosphere(subdivisions=3).apply_translation([x, 0, 0]) for x in (-1.4, 1.4)]
    balls = trimesh.util.concatenate(shapes)
    return Specimen(Mesh(np.asarray(balls.vertices), np.asarray(balls.faces)), "pair")


def seen_at(specimen, x, z):
    hit = specimen.pick(EYE + [x, 0, z], np.array([0.0, 1.0, 0.0]))
    assert hit is not None
    return hit


def test_a_path_goes_over_the_surface_from_place_to_place(ball):
    places = [seen_at(ball, -0.3, 0.0), seen_at(ball, 0.0, 0.2), seen_at(ball, 0.3, 0.0)]
    path = through(ball.rays, places, 25, 0.01)
    assert len(path.positions) == len(path.axes) == len(path.pitches) == 25
    assert np.allclose(np.linalg.norm(path.positions, axis=1), 0.5, atol=0.003)
    assert np.allclose(path.positions[[0, -1]], [places[0].position, places[2].position], atol=1e-6)
    assert np.linalg.norm(path.positions - places[1].position, axis=1).min() < 0.02
    assert np.linalg.norm(np.diff(path.positions, axis=0), axis=1).max() < 0.05  # even steps


def test_the_array_lies_on_the_surface_and_looks_ahead(ball):
    path = through(ball.rays, [seen_at(ball, -0.3, 0.0), seen_at(ball, 0.3, 0.1)], 25, 0.01)
    outward = path.positions / np.linalg.norm(path.positions, axis=1, keepdims=True)
    assert np.einsum("ij,ij->i", path.axes[:, 2], outward).min() > 0.99
    ahead = np.diff(path.positions, axis=0)
    assert (np.einsum("ij,ij->i", path.axes[:-1, 1], ahead) > 0.99 * np.linalg.norm(ahead, axis=1)).all()
    assert np.allclose(np.linalg.det(path.axes), 1)


def test_a_path_that_leaves_the_mesh_says_where(pair):
    places = [seen_at(pair, -0.35, 0.0), seen_at(pair, -0.2, 0.0), seen_at(pair, 0.2, 0.0)]
    assert len(through(pair.rays, places[:2], 9, 0.01).positions) == 9
    with pytest.raises(ValueError, match="leaves the mesh between places 2 and 3"):
        through(pair.rays, places, 25, 0.01)


def test_a_path_over_a_cliff_is_none():
    """Two sheets, one in front of the other: a ray hits one of them everywhere."""
    near, far = (np.array([[a, y, -0.5], [b, y, -0.5], [b, y, 0.5], [a, y, 0.5]]) for a, b, y in SHEETS)
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    sheets = Specimen(Mesh(np.concatenate([near, far]), np.concatenate([faces, faces + 4])), "sheets")
    places = [seen_at(sheets, -0.2, 0.0), seen_at(sheets, 0.2, 0.0)]
    with pytest.raises(ValueError, match="leaves the mesh between places 1 and 2"):
        through(sheets.rays, places, 25, 0.01)
    assert len(through(sheets.rays, [places[1], seen_at(sheets, 0.1, 0.1)], 9, 0.01).positions) == 9


def test_a_path_needs_two_places_that_differ(ball):
    place = seen_at(ball, 0.1, 0.0)
    with pytest.raises(ValueError, match="two places"):
        through(ball.rays, [place], 25, 0.01)
    with pytest.raises(ValueError, match="one and the same"):
        through(ball.rays, [place, place], 25, 0.01)


def test_around_is_the_contour_of_follow(ball):
    surface, first, second = Surface(ball.mesh), seen_at(ball, 0.0, 0.1), seen_at(ball, 0.3, 0.0)
    path = around(surface, first, second, 25, (8, 8), 0.01)
    expected = follow(surface, np.stack([np.zeros(3), first.position, second.position]), 25, (8, 8), 0.01)
    assert np.array_equal(path.positions, expected.positions) and np.array_equal(path.pitches, expected.pitches)
    assert np.allclose(path.axes[:, 2], expected.normals) and "3.14" in path.note
    assert np.allclose(path.line[0], path.line[-1])  # closed
    with pytest.raises(ValueError, match="line"):
        around(surface, first, first, 25, (8, 8), 0.01)
