"""Detectors by spectrum, descriptor and parts (3D-Harris, heat kernel, Song, Leifman, Tasse) on known shapes."""

import numpy as np
import pytest
import trimesh
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from haptic_glance.look.rivals import harris, heat_kernel, leifman, song, tasse
from haptic_glance.look.rivals.leifman import spin_images
from haptic_glance.look.rivals.samples import samples, unit_mesh
from haptic_glance.look.rivals.tasse import fpfh
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import ball_mesh, raised_ball


@pytest.fixture(scope="module", autouse=True)
def few():
    """Fewer samples of a mesh than in use."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(leifman, "SAMPLES", 400)
        patch.setattr(song, "SAMPLES", 300)
        yield


@pytest.fixture(scope="module")
def long():
    return Mesh(ball_mesh(3).vertices * [3, 2, 1] + 0.1 * np.sin(9 * ball_mesh(3).vertices), ball_mesh(3).faces)


@pytest.fixture(scope="module")
def knob():
    """A ball with one bump at +x."""
    return raised_ball([[1, 0, 0]], [0.15], [0.3])


def test_vertices_in_one_place_are_one_and_the_others_are_left_out(long):
    corners = np.concatenate([long.vertices[long.faces].reshape(-1, 3), [[99, 0, 0]]])
    unit = unit_mesh(Mesh(corners, np.arange(3840).reshape(-1, 3)))
    assert 2 * np.linalg.norm(unit.mesh.vertices, axis=1).max() == pytest.approx(1)
    assert len(unit.mesh.vertices) == len(long.vertices) and unit.place[-1] == -1
    assert unit.to_vertices(np.ones(len(long.vertices))).sum() == 3840
    assert unit_mesh(Mesh(np.zeros((3, 3)), [[0, 1, 2]])) is None


def test_samples_are_even_and_joined_to_their_neighbours(long):
    mesh = unit_mesh(long).mesh
    some = samples(mesh, 60)
    apart = np.linalg.norm(mesh.vertices[some.ids][:, None] - mesh.vertices[some.ids], axis=2)
    near = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices[some.ids], axis=2).min(axis=1)
    assert near.max() <= (apart + np.eye(60)).min()  # farthest first: none is farther from all than two from each other
    assert np.array_equal(some.owner[some.ids], np.arange(60))
    assert abs(some.graph.nnz / 60 - 6) < 0.5 and (some.graph != some.graph.T).nnz == 0  # a triangulation's mean degree
    whole = samples(mesh, 9999)
    assert np.array_equal(whole.owner, np.arange(len(mesh.vertices))) and whole.graph.nnz == mesh.adjacency.nnz
    some = samples(mesh, 200)
    spread = some.spread(mesh, mesh.vertices[some.ids, 0])
    assert np.abs(spread - mesh.vertices[:, 0]).max() < 0.15 and np.corrcoef(spread, mesh.vertices[:, 0])[0, 1] > 0.99


def test_harris_on_a_sphere_is_the_closed_form():
    """On z = r - sqrt(r^2 - x^2 - y^2) the fit has p1 = p3 = extent / r, so E = 2 p1^2 I and R = (4 - 0.04 16) p1^4."""
    values = harris.saliency(ball_mesh(4, 0.7))
    extent = harris.EXTENT * 2  # of the size, a diameter, in radii
    assert values.mean() == pytest.approx((4 - 16 * harris.HARRIS) ** 0.25 * extent, rel=0.02)
    assert values.std() < 0.02 * values.mean()


def test_the_eight_best_harris_points_of_a_round_cube_are_its_corners_one_of_each_cluster():
    ball = ball_mesh(4)
    cube = Mesh(ball.vertices * ((np.abs(ball.vertices) ** 6).sum(axis=1) ** (-1 / 6))[:, None], ball.faces)
    places = cube.vertices[harris.points(cube, harris.saliency(cube))]
    assert np.allclose(np.abs(places[:8]), 3 ** (-1 / 6), atol=0.08)
    assert len(np.unique(np.sign(places[:8]), axis=0)) == 8
    distance = np.linalg.norm(places[:, None] - places, axis=2) + np.eye(len(places))
    assert distance.min() > harris.SPACING * 2 * 3 ** (1 / 3)  # from corner to corner


def test_the_heat_kernel_of_a_sphere_is_even_and_its_spectrum_the_known_one():
    ball = ball_mesh(4)
    values = heat_kernel.saliency(ball)
    assert values.std() < 0.005 and values.mean() == pytest.approx(1, abs=1e-3)
    areas = np.full(len(ball.vertices), ball.face_areas.sum() / len(ball.vertices))
    values, functions = heat_kernel._lowest(heat_kernel.laplacian(ball).tocsr(), areas)
    known = np.repeat(np.arange(7), 2 * np.arange(7) + 1)[: heat_kernel.PAIRS]
    assert np.allclose(values, known * (known + 1), rtol=0.05, atol=1e-6)
    assert np.allclose(functions.T * areas @ functions, np.eye(heat_kernel.PAIRS), atol=1e-6)


@pytest.mark.slow
def test_the_heat_points_of_a_starfish_are_its_tips():
    angles = 2 * np.pi * np.arange(5) / 5 + 0.3
    tips = np.stack([np.cos(angles), np.sin(angles), np.zeros(5)], axis=1)
    starfish = raised_ball(tips, [0.25] * 5, [2.5] * 5)  # a ball with thick arms round the equator
    points = heat_kernel.points(starfish, heat_kernel.saliency(starfish))
    directions = trimesh.util.unitize(starfish.vertices[points])
    assert len(points) == 5 and ((directions @ tips.T).max(axis=0) > np.cos(0.1)).all()


@pytest.mark.slow
def test_each_piece_keeps_its_own_heat():
    """A small ball beside an ellipsoid is even and near one, wherever it lies, and adds no point."""
    ball, small = ball_mesh(4), ball_mesh(3, 0.1)
    n, values = len(ball.vertices), []
    for distance in (5, 5000):
        vertices = np.concatenate([ball.vertices * [1, 1, 3], small.vertices + [distance, 0, 0]])
        pair = Mesh(vertices, np.concatenate([ball.faces, small.faces + n]))
        values.append(heat_kernel.saliency(pair))
        assert set(np.abs(pair.vertices[heat_kernel.points(pair, heat_kernel.saliency(pair)), 2]).round(1)) == {3.0}
    assert np.allclose(*values, atol=1e-4) and np.allclose(values[0][n:], 1, atol=1e-4)
    assert np.average(values[0][:n]) == pytest.approx(1, abs=0.3) and values[0][:n].max() > 1.15


def test_an_even_spectrum_is_regular_a_step_is_not_and_equal_eigenvalues_are_equally_irregular():
    even = np.exp(0.1 * np.arange(60))
    rough = song.irregularity(np.concatenate([[0], even]))
    assert rough[0] == 0 and np.allclose(rough[5:-4], 0)
    step = song.irregularity(np.where(np.arange(60) < 30, even, 3 * even))
    assert step.argmax() in (29, 30) and step.max() == pytest.approx(np.log(3) * 4 / 9)
    rough = song.irregularity(np.array([1.0, 2, 2, 2, 3, 5, 9, 17, 30, 50, 99]))
    assert rough[1] == rough[2] == rough[3] and len(set(rough)) > 3


def test_spectral_saliency_is_the_sum_over_the_edges_of_the_filtered_laplacian():
    """A path of three at distances one and two: eigenvalues of its Laplacian by numpy, the sum by hand."""
    positions = np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0]])
    graph = sparse.csr_matrix(np.array([[0, 1, 0], [1, 0, 2], [0, 2, 0]]))
    laplacian = np.array([[1, -1, 0], [-1, 1.25, -0.25], [0, -0.25, 0.25]])
    values, functions = np.linalg.eigh(laplacian)
    ratio = np.log(values[2] / values[1])
    rough = np.exp([0, ratio * 4 / 9, ratio * 4 / 9])  # ends repeated: four of nine are other
    kernel = functions @ np.diag(rough) @ functions.T
    expected = [kernel[0, 1], kernel[0, 1] + kernel[1, 2] / 4, kernel[1, 2] / 4]
    assert song.spectral_saliency(positions, graph) == pytest.approx(np.array(expected))


def test_a_spin_image_holds_heights_and_distances():
    """Half a bin lies between a bin's edge and its middle: 1.5 bins up and 2.5 aside are the middle of a bin."""
    up = np.array([[0.0, 0, 1]])
    image = spin_images(np.array([[2.5, 0, 1.5], [0, 0, 9]]), np.array([3.0, 1]), np.zeros((1, 3)), up, 4.0, 4)[0]
    assert image.shape == (8, 4) and image[5, 2] == pytest.approx(1)
    between = spin_images(np.array([[0, 2.0, -1.5]]), np.array([3.0]), np.zeros((1, 3)), up, 4.0, 4)[0]
    assert between[2, 1:3] == pytest.approx([0.5, 0.5])


def test_the_diffusion_distance_grows_with_the_shift():
    """A city-block distance of the images alone would be two for each."""
    images = np.zeros((4, 16, 8))
    images[range(4), 4, [0, 1, 2, 4]] = 1
    levels = leifman.pyramid(images)
    distances = np.abs(levels[1:] - levels[0]).sum(axis=1)
    assert 2 < distances[0] < distances[1] < distances[2]
    mirrored = leifman.pyramid(images[:, ::-1])
    assert np.allclose(np.abs(mirrored[1:] - mirrored[0]).sum(axis=1), distances)


def test_what_lies_near_a_focus_shares_its_distinctness():
    """Ten vertices on a line, sigma apart, the first two of them foci."""
    steps = np.arange(10)
    shared = leifman.association(np.array([0.9, 0.8] + 8 * [0.1]), leifman.SIGMA * np.abs(steps[:, None] - steps))
    assert shared == pytest.approx(np.append(0.9, 0.8 * np.exp(-(steps[:9] ** 2) / 2)))


def limb_ends(mesh):
    unit = unit_mesh(mesh).mesh
    some = samples(unit, leifman.SAMPLES)
    return unit.vertices[some.ids[leifman.limb_ends(dijkstra(some.graph, directed=False))]]


def test_a_ball_has_no_limbs_a_long_body_two_and_each_part_its_own(monkeypatch):
    ball = ball_mesh(3)
    body = Mesh(ball.vertices * [3, 1, 1], ball.faces)
    assert not len(limb_ends(ball)) and not leifman.saliency(ball).any()
    assert np.allclose(np.abs(limb_ends(body)), [[0.5, 0, 0]] * 2, atol=0.03)
    pair = Mesh(np.r_[body.vertices, ball.vertices + [0, 5, 0]], np.r_[ball.faces, ball.faces + len(ball.vertices)])
    ends = limb_ends(pair)
    assert len(ends) == 2 and np.ptp(ends[:, 0]) > 10 * np.ptp(ends[:, 1])
    monkeypatch.setattr(leifman, "FLOOR", 9)  # nothing is distinct
    values, along = leifman.saliency(body), np.abs(ball.vertices[:, 0])
    assert values[along > 0.98].min() > 0.4 and values[along < 0.5].max() < 0.01


def test_a_bump_is_of_interest_to_leifman_and_the_ball_under_it_is_not(knob):
    values = leifman.saliency(knob)
    top = knob.vertices[:, 0].argmax()
    assert values[top] > 0.5 and values[knob.vertices[:, 0] < 0].max() < 0.1
    assert np.linalg.norm(knob.vertices[leifman.points(knob, values)[0]] - knob.vertices[top]) < 0.2


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
    counts = fpfh(PAIR, np.array(normals, dtype=float), EACH_OTHER, STARTS)
    assert [list(part.nonzero()[0]) for part in counts[0].reshape(3, 11)] == [[k] for k in bins]
    assert np.array_equal(counts[0], counts[1]) and counts.sum() == 6
    assert not fpfh(PAIR, np.array([[0.0, 0, 0], [0, 0, 1]]), EACH_OTHER, STARTS).any()  # a zero normal has none


@pytest.mark.slow
def test_a_rare_shape_is_more_salient_to_tasse_than_a_common_one():
    """One small ball among four large ones."""
    large, small = ball_mesh(3), ball_mesh(3, 0.2)
    places = np.array([[-6.0, -6, 0], [-6, 6, 0], [6, -6, 0], [6, 6, 0]])
    vertices = np.concatenate([*(large.vertices + place for place in places), small.vertices])
    faces = np.concatenate([large.faces + k * len(large.vertices) for k in range(5)])
    values = tasse.saliency(Mesh(vertices, faces)).reshape(5, -1)
    assert values[4].min() > 2 * values[:4].max()
