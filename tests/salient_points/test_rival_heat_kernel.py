"""The heat kernel signature on shapes whose kernel or whose tips are known."""

import numpy as np
import pytest
import trimesh

from stages.kit import Mesh
from stages.salient_points.rivals import heat_kernel


def mesh_of(shape):
    return Mesh(shape.vertices, shape.faces)


def starfish(arms=5):
    """A ball with thick arms round the equator; returns the mesh and the directions of the tips."""
    ball = trimesh.creation.icosphere(subdivisions=4)
    angles = 2 * np.pi * np.arange(arms) / arms + 0.3
    tips = np.stack([np.cos(angles), np.sin(angles), np.zeros(arms)], axis=1)
    radius = 1 + 2.5 * np.exp(-(2 - 2 * ball.vertices @ tips.T) / (2 * 0.25**2)).sum(axis=1)
    return Mesh(ball.vertices * radius[:, None], ball.faces), tips


def test_it_is_even_on_a_sphere():
    values = heat_kernel.saliency(mesh_of(trimesh.creation.icosphere(subdivisions=4)))
    assert values.std() < 0.005 and values.mean() == pytest.approx(1, abs=1e-3)


def test_the_spectrum_of_a_sphere_is_the_known_one():
    ball = mesh_of(trimesh.creation.icosphere(subdivisions=4))
    areas = np.full(len(ball.vertices), ball.face_areas.sum() / len(ball.vertices))
    values, functions = heat_kernel._lowest(heat_kernel.laplacian(ball).tocsr(), areas)
    known = np.repeat(np.arange(7), 2 * np.arange(7) + 1)[: heat_kernel.PAIRS]
    assert np.allclose(values, known * (known + 1), rtol=0.05, atol=1e-6)
    assert np.allclose(functions.T * areas @ functions, np.eye(heat_kernel.PAIRS), atol=1e-6)


def test_more_eigenpairs_change_nothing(monkeypatch):
    mesh, _ = starfish()
    few = heat_kernel.saliency(mesh)
    monkeypatch.setattr(heat_kernel, "PAIRS", 150)
    assert np.allclose(few, heat_kernel.saliency(mesh), rtol=1e-4)


def test_the_points_of_a_starfish_are_its_tips():
    mesh, tips = starfish()
    points = heat_kernel.points(mesh)
    directions = trimesh.util.unitize(mesh.vertices[points])
    assert len(points) == 5 and ((directions @ tips.T).max(axis=0) > np.cos(0.1)).all()


def test_the_points_of_an_ellipsoid_are_its_two_tips():
    ball = trimesh.creation.icosphere(subdivisions=4)
    points = heat_kernel.points(Mesh(ball.vertices * [1, 1, 3], ball.faces))
    assert len(points) == 2 and np.allclose(np.abs(ball.vertices[points, 2]), 1, atol=0.02)


def test_bending_hardly_changes_it():
    """Heat knows the surface from within: a strip rolled up keeps its signature (Sun 2009, section 3)."""
    grid = np.stack([*np.mgrid[:61, :21].reshape(2, -1) / 20.0, np.zeros(1281)], axis=1)
    first = np.flatnonzero((grid[:, 0] < 3) & (grid[:, 1] < 1))
    faces = np.stack([first, first + 21, first + 22, first, first + 22, first + 1], axis=1).reshape(-1, 3)
    rolled = np.stack([np.cos(grid[:, 0]), grid[:, 1], np.sin(grid[:, 0])], axis=1)
    flat, bent = heat_kernel.saliency(Mesh(grid, faces)), heat_kernel.saliency(Mesh(rolled, faces))
    assert flat.std() > 0.2 and np.abs(bent - flat).max() < 0.01


def test_each_piece_keeps_its_own_heat():
    """A small ball beside an ellipsoid is even and near one, wherever it lies, and adds no point."""
    ball = trimesh.creation.icosphere(subdivisions=4)
    small = trimesh.creation.icosphere(subdivisions=3, radius=0.1)
    n = len(ball.vertices)
    values = []
    for distance in (5, 5000):
        vertices = np.concatenate([ball.vertices * [1, 1, 3], small.vertices + [distance, 0, 0]])
        both = Mesh(vertices, np.concatenate([ball.faces, small.faces + n]))
        values.append(heat_kernel.saliency(both))
        assert set(np.abs(both.vertices[heat_kernel.points(both), 2]).round(1)) == {3.0}
    assert np.allclose(*values, atol=1e-4) and np.allclose(values[0][n:], 1, atol=1e-4)
    assert np.average(values[0][:n]) == pytest.approx(1, abs=0.3) and values[0][:n].max() > 1.15
