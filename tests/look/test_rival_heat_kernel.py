"""The heat kernel signature on shapes whose kernel or whose tips are known."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.rivals import heat_kernel
from haptic_glance.mesh.mesh import Mesh


@pytest.fixture(scope="module")
def tips():
    angles = 2 * np.pi * np.arange(5) / 5 + 0.3
    return np.stack([np.cos(angles), np.sin(angles), np.zeros(5)], axis=1)


@pytest.fixture(scope="module")
def starfish(raised, tips):
    """A ball with thick arms round the equator."""
    return raised(tips, [0.25] * 5, [2.5] * 5, subdivisions=4)


def test_it_is_even_on_a_sphere(sphere):
    values = heat_kernel.saliency(sphere(4))
    assert values.std() < 0.005 and values.mean() == pytest.approx(1, abs=1e-3)


def test_the_spectrum_of_a_sphere_is_the_known_one(sphere):
    ball = sphere(4)
    areas = np.full(len(ball.vertices), ball.face_areas.sum() / len(ball.vertices))
    values, functions = heat_kernel._lowest(heat_kernel.laplacian(ball).tocsr(), areas)
    known = np.repeat(np.arange(7), 2 * np.arange(7) + 1)[: heat_kernel.PAIRS]
    assert np.allclose(values, known * (known + 1), rtol=0.05, atol=1e-6)
    assert np.allclose(functions.T * areas @ functions, np.eye(heat_kernel.PAIRS), atol=1e-6)


@pytest.mark.slow
def test_more_eigenpairs_change_nothing(starfish, monkeypatch):
    few = heat_kernel.saliency(starfish)
    monkeypatch.setattr(heat_kernel, "PAIRS", 150)
    assert np.allclose(few, heat_kernel.saliency(starfish), rtol=1e-4)


def test_the_points_of_a_starfish_are_its_tips(starfish, tips):
    points = heat_kernel.points(starfish)
    directions = trimesh.util.unitize(starfish.vertices[points])
    assert len(points) == 5 and ((directions @ tips.T).max(axis=0) > np.cos(0.1)).all()


def test_the_points_of_an_ellipsoid_are_its_two_tips(sphere):
    ball = sphere(4)
    points = heat_kernel.points(Mesh(ball.vertices * [1, 1, 3], ball.faces))
    assert len(points) == 2 and np.allclose(np.abs(ball.vertices[points, 2]), 1, atol=0.02)


def test_bending_hardly_changes_it(grid):
    """Heat knows the surface from within: a strip rolled up keeps its signature (Sun 2009, section 3)."""
    plane, faces = grid(61, 21)
    plane = plane / 20
    rolled = np.stack([np.cos(plane[:, 0]), plane[:, 1], np.sin(plane[:, 0])], axis=1)
    flat, bent = heat_kernel.saliency(Mesh(plane, faces)), heat_kernel.saliency(Mesh(rolled, faces))
    assert flat.std() > 0.2 and np.abs(bent - flat).max() < 0.01


@pytest.mark.slow
def test_each_piece_keeps_its_own_heat(sphere):
    """A small ball beside an ellipsoid is even and near one, wherever it lies, and adds no point."""
    ball = sphere(4)
    small = sphere(3, 0.1)
    n = len(ball.vertices)
    values = []
    for distance in (5, 5000):
        vertices = np.concatenate([ball.vertices * [1, 1, 3], small.vertices + [distance, 0, 0]])
        both = Mesh(vertices, np.concatenate([ball.faces, small.faces + n]))
        values.append(heat_kernel.saliency(both))
        assert set(np.abs(both.vertices[heat_kernel.points(both), 2]).round(1)) == {3.0}
    assert np.allclose(*values, atol=1e-4) and np.allclose(values[0][n:], 1, atol=1e-4)
    assert np.average(values[0][:n]) == pytest.approx(1, abs=0.3) and values[0][:n].max() > 1.15
