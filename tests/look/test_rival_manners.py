"""What these detectors owe their caller: the same answer however the mesh is held, and none for no shape."""

from dataclasses import dataclass
from types import ModuleType

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

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

X = np.array([1.0, 0, 0])


@dataclass(frozen=True)
class Held:
    """How closely a rival keeps its answer."""

    rival: ModuleType
    same: float  # of the largest value: what another order or size of the mesh may change
    most: float = np.inf  # the largest value that there may be
    samples: int = 0  # that stand for the mesh: fewer than in use, since this does not depend on how many


HELD = [
    Held(harris, 1e-4),
    Held(corners, 1e-4),
    Held(heat_kernel, 1e-4),
    Held(mesh_saliency, 1e-9, most=1 + 1e-12),
    Held(salient_points, 1e-9, most=1 + 1e-12),
    Held(sift, 1e-9, most=1 + 1e-12),
    Held(leifman, 1e-6, most=1 + 1e-12, samples=300),
    Held(song, 1e-4, samples=300),
    Held(tasse, 1e-6, most=1 + 1e-12),
]


def name_of(module):
    return module.__name__.rpartition(".")[2]


def over(*rivals):
    """Runs a test over these rivals alone."""
    return pytest.mark.parametrize("rival", rivals, ids=name_of)


@pytest.fixture(scope="module", params=HELD, ids=lambda held: name_of(held.rival))
def held(request):
    with pytest.MonkeyPatch.context() as patch:
        if request.param.samples:
            patch.setattr(request.param.rival, "SAMPLES", request.param.samples)
        yield request.param


@pytest.fixture(scope="module")
def rival(held):
    return held.rival


@pytest.fixture(scope="module")
def bumpy(raised):
    """A long ball with three unlike bumps, of which every rival finds some: 2,562 vertices."""
    tops = trimesh.util.unitize(np.array([[1.0, 0.2, 0.1], [-0.3, 1, 0.4], [0.1, -0.6, -1]]))
    ball = raised(tops, [0.12, 0.15, 0.2], [0.5, 0.4, 0.6], subdivisions=4)
    return Mesh(ball.vertices * [1, 0.5, 0.5], ball.faces)


@pytest.fixture(scope="module")
def values(rival, bumpy, saliency_of):
    return saliency_of(rival, bumpy)


@pytest.mark.slow
def test_answers_in_the_agreed_form(held, bumpy, values):
    points = held.rival.points(bumpy)
    assert values.shape == (len(bumpy.vertices),) and values.dtype == np.float64
    assert values.min() >= 0 and 0 < values.max() <= held.most
    assert points.dtype == np.int64 and 0 < len(points) == len(set(points))
    assert (np.diff(values[points]) <= 1e-8 * values.max()).all()
    assert np.array_equal(points, held.rival.points(bumpy, values))


@pytest.mark.slow
def test_does_not_depend_on_size_and_vertex_order(held, bumpy, values):
    order = np.random.default_rng(5).permutation(len(bumpy.vertices))
    place = np.argsort(order)
    shuffled = Mesh(7 * bumpy.vertices[order], np.roll(place[bumpy.faces][::-1], 1, axis=1))
    moved = held.rival.saliency(shuffled)
    assert np.allclose(moved, values[order], rtol=0, atol=held.same * values.max())
    assert np.array_equal(order[held.rival.points(shuffled, moved)], held.rival.points(bumpy, values))


@pytest.mark.slow
@pytest.mark.parametrize("size", [1e-5, 1e5])
@over(harris, corners, heat_kernel)
def test_does_not_depend_on_scale_turn_and_place(rival, bumpy, saliency_of, size):
    turn = trimesh.transformations.rotation_matrix(1.0, [1, 2, 3])[:3, :3]
    moved = Mesh(size * (bumpy.vertices @ turn.T + [3, -2, 1]), bumpy.faces)
    values = saliency_of(rival, bumpy)
    assert np.allclose(rival.saliency(moved), values, atol=1e-4 * values.max())
    assert set(rival.points(moved)) == set(rival.points(bumpy))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rival", "largest", "correlation", "apart"),
    [(mesh_saliency, 0.05, 0.99, 0), (salient_points, 0.05, 0.99, 0), (sift, 1, 0.95, 0.05)],  # sift: within a voxel
    ids=["mesh_saliency", "salient_points", "sift"],
)
def test_a_turned_mesh_keeps_its_map_and_first_point(rival, largest, correlation, apart, bump_and_swell, saliency_of):
    mesh, values = bump_and_swell, saliency_of(rival, bump_and_swell)
    turn = Rotation.from_euler("xyz", [20, 30, 50], degrees=True).as_matrix()
    turned = Mesh(mesh.vertices @ turn.T, mesh.faces)
    moved = rival.saliency(turned)
    assert np.abs(moved - values).max() <= largest and np.corrcoef(moved, values)[0, 1] > correlation
    first = mesh.vertices[[rival.points(turned, moved)[0], rival.points(mesh, values)[0]]]
    assert np.linalg.norm(first[0] - first[1]) <= apart


@pytest.mark.slow
def test_does_not_depend_on_which_side_is_out(rival, bumpy, values):
    inward = Mesh(bumpy.vertices, bumpy.faces[:, ::-1])
    assert np.allclose(rival.saliency(inward), values, atol=1e-4)


@pytest.fixture(scope="module")
def bad_meshes(sphere, grid):
    triangle = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]])
    ball, nothing = sphere(2), np.zeros((0, 3), int)
    long = ball.vertices * [1, 0.3, 0.3]
    pair = np.concatenate([ball.faces, ball.faces + len(long)])
    soup = long[ball.faces].reshape(-1, 3)  # coincident vertices: no face shares one
    return {
        "no vertices": (np.zeros((0, 3)), nothing),
        "no faces": (triangle, nothing),
        "one triangle": (triangle, [[0, 1, 2]]),
        "no area": (np.zeros((3, 3)), [[0, 1, 2]]),
        "a needle": (triangle * [1, 0, 0], [[0, 1, 2]]),
        "a line": ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]]),
        "flat": grid(20, 20),
        "far pieces": (np.concatenate([long, long + 1000]), pair),
        "very far pieces": (np.concatenate([long, long + [1e6, 0, 0]]), pair),
        "inward": (long, ball.faces[:, ::-1]),
        "a vertex in no face": (np.concatenate([long, [[0, 0, 2]]]), ball.faces),
        "a far vertex in no face": (np.concatenate([long, [[9, 9, 9]]]), ball.faces),
        "coincident vertices": (soup, np.arange(len(soup)).reshape(-1, 3)),
        "a face twice": (triangle, [[0, 1, 2], [0, 1, 2], [2, 1, 0]]),
        "a face on one edge": (long, np.concatenate([ball.faces, [[0, 0, 12], [5, 5, 5]]])),
    }


BAD = [
    "no vertices", "no faces", "one triangle", "no area", "a needle", "a line", "flat", "far pieces",
    "very far pieces", "inward", "a vertex in no face", "a far vertex in no face", "coincident vertices",
    "a face twice", "a face on one edge",
]  # fmt: skip


@pytest.mark.slow
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", BAD)
def test_bad_meshes_give_finite_values_and_points_on_the_surface(rival, bad_meshes, name):
    mesh = Mesh(*bad_meshes[name])
    values = rival.saliency(mesh)
    points = rival.points(mesh, values)
    assert values.shape == (len(mesh.vertices),) and np.isfinite(values).all() and (values >= 0).all()
    assert points.dtype == np.int64 and np.isin(points, mesh.faces).all()


@pytest.mark.slow
def test_a_vertex_in_no_face_is_not_salient(rival, bumpy):
    """It lies in the tip of the highest bump."""
    top = bumpy.vertices[np.linalg.norm(bumpy.vertices, axis=1).argmax()]
    mesh = Mesh(np.concatenate([bumpy.vertices, [0.93 * top]]), bumpy.faces)
    values = rival.saliency(mesh)
    points = rival.points(mesh, values)
    assert values[-1] == 0 < values.max() and len(bumpy.vertices) not in points and len(points)


def test_values_of_another_mesh_are_refused(rival, bumpy):
    with pytest.raises(ValueError, match="one per vertex"):
        rival.points(bumpy, np.ones(7))


@pytest.mark.slow
@over(mesh_saliency, salient_points, sift, tasse)
def test_a_sphere_and_a_plane_have_neither_saliency_nor_points(rival, sphere, grid):
    for mesh in sphere(4), Mesh(*grid(9, 9)):
        values = rival.saliency(mesh)
        assert values.max() == 0
        assert len(rival.points(mesh, values)) == 0


@pytest.mark.slow
@over(mesh_saliency, salient_points)
def test_a_bump_far_below_the_scales_counts_less_than_one_of_the_right_size(rival, sphere, raised):
    """The small bump, one vertex wide, is as steep as the other."""
    directions = sphere(5).vertices
    right, fine = np.argmax(directions @ X), np.argmax(directions @ [0, 1, 0])
    values = rival.saliency(raised(directions[[right, fine]], [0.08, 0.013], [0.06, 0.01]))
    assert values[fine] < 0.5 * values[right]


@pytest.mark.slow
@over(mesh_saliency, salient_points)
def test_the_ends_of_an_ellipsoid_come_first(rival, sphere):
    ellipsoid = Mesh(sphere(4).vertices * [1, 0.3, 0.3], sphere(4).faces)
    np.testing.assert_allclose(np.abs(ellipsoid.vertices[rival.points(ellipsoid)[:2]]), [X, X], atol=0.02)


@pytest.mark.slow
@over(mesh_saliency, salient_points)
def test_the_corners_of_a_cube_come_first(rival, cube):
    mesh = cube(5)
    first = mesh.vertices[rival.points(mesh)[:8]]
    assert len(first) == 8
    np.testing.assert_allclose(np.abs(first), 0.5)
