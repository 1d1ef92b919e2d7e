"""What these detectors owe their caller: the same answer however the mesh is held, and none for no shape."""

from dataclasses import dataclass
from types import ModuleType

import numpy as np
import pytest
import trimesh

from haptic_glance.look.points.methods import PUBLISHED
from haptic_glance.look.rivals import (
    corners,
    harris,
    heat_kernel,
    leifman,
    mesh_saliency,
    salient_points,
    sift,
    song,
    tasse,
)
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import ball_mesh, flat_grid, raised_ball


@dataclass(frozen=True)
class Held:
    """How closely a rival keeps its answer."""

    rival: ModuleType
    same: float  # of the largest value: what another order or size of the mesh may change
    most: float = np.inf  # the largest value that there may be
    alike: float = 0.99  # correlation with the map of a moved mesh: ties are told apart anew, voxels hold other parts
    samples: int = 0  # that stand for the mesh: fewer than in use, since this does not depend on how many
    turns: bool = True  # or else a turn draws other samples


EXACTLY = 1 - 1e-6
HELD = [
    Held(harris, 1e-4, alike=EXACTLY),
    Held(corners, 1e-4, alike=EXACTLY),
    Held(heat_kernel, 1e-4, alike=EXACTLY),
    Held(mesh_saliency, 1e-9, most=1 + 1e-12),
    Held(salient_points, 1e-9, most=1 + 1e-12),
    Held(sift, 1e-9, most=1 + 1e-12, alike=0.95),
    Held(leifman, 1e-6, most=1 + 1e-12, samples=300, turns=False),
    Held(song, 1e-4, samples=300, turns=False),
    Held(tasse, 1e-6, most=1 + 1e-12),
]
HELD += [Held(rival, 1e-6) for rival in PUBLISHED.values() if rival not in [held.rival for held in HELD]]


@pytest.fixture(scope="module", params=HELD, ids=lambda held: held.rival.__name__.rpartition(".")[2])
def held(request):
    with pytest.MonkeyPatch.context() as patch:
        if request.param.samples:
            patch.setattr(request.param.rival, "SAMPLES", request.param.samples)
        yield request.param


@pytest.fixture(scope="module")
def rival(held):
    return held.rival


@pytest.fixture(scope="module")
def bumpy():
    """A long ball with three unlike bumps, of which every rival finds some: 642 vertices."""
    tops = trimesh.util.unitize(np.array([[1.0, 0.2, 0.1], [-0.3, 1, 0.4], [0.1, -0.6, -1]]))
    ball = raised_ball(tops, [0.12, 0.15, 0.2], [0.5, 0.4, 0.6], subdivisions=3)
    return Mesh(ball.vertices * [1, 0.5, 0.5], ball.faces)


@pytest.fixture(scope="module")
def values(rival, bumpy):
    return rival.saliency(bumpy)


@pytest.mark.slow
def test_answers_in_the_agreed_form_and_does_not_depend_on_size_and_vertex_order(held, bumpy, values):
    points = held.rival.points(bumpy, values)
    assert values.shape == (len(bumpy.vertices),) and values.dtype == np.float64
    assert values.min() >= 0 and 0 < values.max() <= held.most
    assert points.dtype == np.int64 and 0 < len(points) == len(set(points))
    assert (np.diff(values[points]) <= 1e-8 * values.max()).all()
    order = np.random.default_rng(5).permutation(len(bumpy.vertices))
    place = np.argsort(order)
    shuffled = Mesh(7 * bumpy.vertices[order], np.roll(place[bumpy.faces][::-1], 1, axis=1))
    moved = held.rival.saliency(shuffled)
    assert np.allclose(moved, values[order], rtol=0, atol=held.same * values.max())
    assert np.array_equal(order[held.rival.points(shuffled, moved)], points)


@pytest.mark.slow
def test_does_not_depend_on_scale_turn_place_and_which_side_is_out(held, bumpy, values):
    turn = trimesh.transformations.rotation_matrix(1.0, [1, 2, 3])[:3, :3] if held.turns else np.eye(3)
    moved = Mesh(1e-5 * (bumpy.vertices @ turn.T + [3, -2, 1]), bumpy.faces[:, ::-1])
    again = held.rival.saliency(moved)
    assert np.corrcoef(again, values)[0, 1] > held.alike
    if held.alike == EXACTLY:
        assert np.allclose(again, values, atol=1e-4 * values.max())
        assert set(held.rival.points(moved, again)) == set(held.rival.points(bumpy, values))


@pytest.fixture(scope="module")
def bad_meshes(bumpy):
    triangle = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    ball, nothing = ball_mesh(2), np.zeros((0, 3), int)
    long = ball.vertices * [1, 0.3, 0.3]
    soup = long[ball.faces].reshape(-1, 3)  # coincident vertices: no face shares one
    tip = bumpy.vertices[np.linalg.norm(bumpy.vertices, axis=1).argmax()]  # a vertex in no face lies below it
    return {
        "no vertices": (np.zeros((0, 3)), nothing),
        "no faces": (triangle, nothing),
        "one triangle": (triangle, [[0, 1, 2]]),
        "a needle": (triangle * [1, 0, 0], [[0, 1, 2]]),
        "flat": (flat_grid(20, 20).vertices, flat_grid(20, 20).faces),
        "far pieces": (np.concatenate([long, long + [1e6, 0, 0]]), np.concatenate([ball.faces, ball.faces + 162])),
        "coincident vertices": (soup, np.arange(len(soup)).reshape(-1, 3)),
        "a face twice": (triangle, [[0, 1, 2], [0, 1, 2], [2, 1, 0]]),
        "untidy": (np.r_[bumpy.vertices, [0.93 * tip]], np.r_[bumpy.faces, [[0, 0, 12], [5, 5, 5]]]),
    }


@pytest.mark.filterwarnings("error")
@pytest.mark.slow
def test_bad_meshes_give_finite_values_and_points_on_the_surface(rival, bad_meshes):
    for name, (vertices, faces) in bad_meshes.items():
        mesh = Mesh(vertices, faces)
        values = rival.saliency(mesh)
        points = rival.points(mesh, values)
        assert values.shape == (len(mesh.vertices),) and np.isfinite(values).all() and (values >= 0).all(), name
        assert points.dtype == np.int64 and np.isin(points, mesh.faces).all(), name
        assert not np.delete(values, mesh.used).any() and (name != "untidy" or len(points)), name


def test_values_of_another_mesh_are_refused(rival, bumpy):
    with pytest.raises(ValueError, match="one per vertex"):
        rival.points(bumpy, np.ones(7))


@pytest.mark.parametrize("smooth", [mesh_saliency, salient_points, sift, tasse])
@pytest.mark.slow
def test_a_sphere_and_a_plane_have_neither_saliency_nor_points(smooth):
    for mesh in ball_mesh(4), flat_grid(9, 9):
        values = smooth.saliency(mesh)
        assert values.max() == 0 and len(smooth.points(mesh, values)) == 0
