"""What each of these detectors owes its caller: the same answer however the mesh is held, and none for no shape."""

import numpy as np
import pytest
import trimesh

from stages.kit import Mesh
from stages.salient_points.rivals import corners, harris, heat_kernel


@pytest.fixture(scope="module")
def bumpy():
    """A ball with three unlike bumps: 2,562 vertices."""
    ball = trimesh.creation.icosphere(subdivisions=4)
    tops = trimesh.util.unitize(np.array([[1.0, 0.2, 0.1], [-0.3, 1, 0.4], [0.1, -0.6, -1]]))
    squared = 2 - 2 * ball.vertices @ tops.T
    height = np.exp(-squared / (2 * np.array([0.12, 0.15, 0.2]) ** 2)) @ [0.5, 0.4, 0.6]
    return Mesh(ball.vertices * (1 + height[:, None]), ball.faces)


@pytest.fixture(params=[harris, corners, heat_kernel], ids=lambda module: module.__name__.rpartition(".")[2])
def rival(request):
    return request.param


def test_answers_in_the_agreed_form(rival, bumpy):
    values, points = rival.saliency(bumpy), rival.points(bumpy)
    assert values.shape == (len(bumpy.vertices),) and values.dtype == np.float64 and values.min() >= 0
    assert points.dtype == np.int64 and 0 < len(points) == len(set(points))
    assert (np.diff(values[points]) <= 1e-8 * values.max()).all()
    assert np.array_equal(points, rival.points(bumpy, values))


def test_does_not_depend_on_vertex_order(rival, bumpy):
    order = np.random.default_rng(5).permutation(len(bumpy.vertices))
    place = np.argsort(order)
    shuffled = Mesh(bumpy.vertices[order], np.roll(place[bumpy.faces][::-1], 1, axis=1))
    values = rival.saliency(bumpy)
    assert np.allclose(rival.saliency(shuffled), values[order], atol=1e-4 * values.max())
    assert np.array_equal(order[rival.points(shuffled)], rival.points(bumpy))


@pytest.mark.parametrize("size", [1e-5, 1e5])
def test_does_not_depend_on_scale_turn_and_place(rival, bumpy, size):
    turn = trimesh.transformations.rotation_matrix(1.0, [1, 2, 3])[:3, :3]
    moved = Mesh(size * (bumpy.vertices @ turn.T + [3, -2, 1]), bumpy.faces)
    values = rival.saliency(bumpy)
    assert np.allclose(rival.saliency(moved), values, atol=1e-4 * values.max())
    assert set(rival.points(moved)) == set(rival.points(bumpy))


def test_does_not_depend_on_which_side_is_out(rival, bumpy):
    inward = Mesh(bumpy.vertices, bumpy.faces[:, ::-1])
    assert np.allclose(rival.saliency(inward), rival.saliency(bumpy), atol=1e-4)


def bad_meshes():
    triangle = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    ball = trimesh.creation.icosphere(subdivisions=3)
    grid = np.stack([*np.mgrid[:20, :20].reshape(2, -1), np.zeros(400)], axis=1).astype(float)
    corner = np.flatnonzero((grid[:, 0] < 19) & (grid[:, 1] < 19))
    squares = np.stack([corner, corner + 20, corner + 21, corner, corner + 21, corner + 1], axis=1).reshape(-1, 3)
    far = np.concatenate([ball.vertices, ball.vertices + [1e6, 0, 0]])
    soup = ball.vertices[ball.faces].reshape(-1, 3)  # coincident vertices: no face shares one
    return {
        "no vertices": (np.zeros((0, 3)), np.zeros((0, 3), int)),
        "no faces": (triangle, np.zeros((0, 3), int)),
        "one triangle": (triangle, [[0, 1, 2]]),
        "no area": (np.zeros((3, 3)), [[0, 1, 2]]),
        "a needle": (triangle * [1, 0, 0], [[0, 1, 2]]),
        "flat": (grid, squares),
        "far pieces": (far, np.concatenate([ball.faces, ball.faces + len(ball.vertices)])),
        "a vertex in no face": (np.concatenate([ball.vertices, [[9.0, 9, 9]]]), ball.faces),
        "coincident vertices": (soup, np.arange(len(soup)).reshape(-1, 3)),
        "a face twice": (triangle, [[0, 1, 2], [0, 1, 2], [2, 1, 0]]),
        "a face on one edge": (ball.vertices, np.concatenate([ball.faces, [[0, 0, 12], [5, 5, 5]]])),
    }


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", bad_meshes())
def test_bad_meshes_give_finite_values(rival, name):
    mesh = Mesh(*bad_meshes()[name])
    values = rival.saliency(mesh)
    assert values.shape == (len(mesh.vertices),) and np.isfinite(values).all() and (values >= 0).all()
    assert (rival.points(mesh, values) < len(mesh.vertices)).all()


def test_a_vertex_in_no_face_is_not_salient(rival):
    mesh = Mesh(*bad_meshes()["a vertex in no face"])
    assert rival.saliency(mesh)[-1] == 0 and len(mesh.vertices) - 1 not in rival.points(mesh)


def test_values_of_another_mesh_are_refused(rival, bumpy):
    with pytest.raises(ValueError, match="one a vertex"):
        rival.points(bumpy, np.ones(7))
