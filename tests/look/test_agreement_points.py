"""Agreement of interest points: the errors of Dutagaci et al. (2012), ground-truth points and distances on surfaces."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.agreement import gaze_peaks, interest_point_errors
from haptic_glance.look.agreement.interest_points import Geodesics
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import flat_grid, mesh_of

BALL = mesh_of(trimesh.creation.icosphere(3, radius=0.5))
ONE_FACE = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
TWO_BOXES = mesh_of(
    trimesh.util.concatenate([trimesh.creation.box(), trimesh.creation.box().apply_translation([3, 0, 0])])
)


def nearest(mesh, place):
    return int(np.argmin(np.linalg.norm(mesh.vertices - place, axis=1)))


def test_errors_worked_out_by_hand():
    # On a line of a grid: people at x = 0 (3 of them) and x = 10 (1); detected at x = 2, 3 and 11. Diagonal 20 sqrt(2).
    mesh = flat_grid(21, 21)
    detected = [2, 3, 11, 11]  # a vertex that is detected twice counts once
    errors = interest_point_errors(mesh, detected, [0, 10], [3, 1], np.array([0.9, 1, 1.9, 2, 9]) / mesh.diagonal)
    assert errors["fne"] == pytest.approx([1, 0.5, 0.5, 0, 0])
    assert errors["fpe"] == pytest.approx([1, 2 / 3, 2 / 3, 1 / 3, 1 / 3])  # x = 2 and 3 find one point together
    assert errors["wme"] == pytest.approx([1, 3 / 4, 3 / 4, 0, 0])
    nearer = interest_point_errors(mesh, [4], [0, 10], tolerances=[8 / mesh.diagonal])  # it finds its nearest point
    assert nearer["fne"] == [0.5] and nearer["fpe"] == [0]


def test_a_tolerance_of_whole_edges_reaches_their_end():
    line = flat_grid(21, 21)
    mesh = Mesh(0.1 * line.vertices, line.faces)  # in floats three edges are longer than 0.3
    for edges in (1, 3, 6, 7, 20):
        assert interest_point_errors(mesh, [edges], [0], tolerances=[edges / 20 / np.sqrt(2)])["fne"] == [0]


def test_of_two_points_as_near_the_heavier_is_found_and_weights_may_differ_by_tolerance():
    mesh = flat_grid(21, 21)
    for points, weights in (([0, 10], [1, 3]), ([10, 0], [3, 1])):
        assert interest_point_errors(mesh, [5], points, weights, [6 / mesh.diagonal])["wme"] == [0.25]
    errors = interest_point_errors(mesh, [0], [0, 10], [[1, 1], [1, 3]], [0, 2 / mesh.diagonal])
    assert errors["wme"] == pytest.approx([1 / 2, 3 / 4])


@pytest.mark.parametrize(
    ("mesh", "detected", "points", "expected"),
    [
        (BALL, [], [1, 2], {"fne": 1, "wme": 1, "fpe": 0}),
        (TWO_BOXES, [8], [0], {"fne": 1, "wme": 1, "fpe": 1}),  # on the other piece
        (ONE_FACE, [1], [0], {"fne": 1}),
        (Mesh(np.zeros((3, 3)), np.zeros((0, 3), dtype=int)), [1], [0], {"fne": 0}),  # all at one place
    ],
)
def test_odd_detections_and_meshes_have_defined_errors(mesh, detected, points, expected):
    errors = interest_point_errors(mesh, detected, points)
    assert {name: set(errors[name]) for name in expected} == {name: {value} for name, value in expected.items()}


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: interest_point_errors(BALL, [0], []), "points must be at least one"),
        (lambda: interest_point_errors(BALL, [0], [1, 1]), "points.*without repetitions"),
        (lambda: interest_point_errors(BALL, [0], [642]), "points must be vertex ids"),
        (lambda: interest_point_errors(BALL, [-1], [1]), "detected"),
        (lambda: interest_point_errors(BALL, [0.5], [1]), "detected"),
        (lambda: interest_point_errors(BALL, [0], [1, 2], [1]), "weights must have shape"),
        (lambda: interest_point_errors(BALL, [0], [1, 2], [1, -1]), "weights must be finite, not negative"),
        (lambda: interest_point_errors(BALL, [0], [1, 2], [0, 0]), "weights"),
        (lambda: interest_point_errors(BALL, [0], [1], None, [-0.1]), "tolerances"),
        (lambda: interest_point_errors(BALL, [0], [1], None, [np.nan]), "tolerances"),
        (lambda: gaze_peaks(BALL, np.ones(641)), "642"),
        (lambda: gaze_peaks(BALL, np.full(642, np.nan)), "finite"),
        (lambda: gaze_peaks(BALL, -np.ones(642)), "negative"),
        (lambda: gaze_peaks(BALL, np.zeros(642)), "empty"),
        (lambda: gaze_peaks(BALL, np.full(642, 0.1)), "uniform"),
        (lambda: gaze_peaks(BALL, np.ones(642), radius=0), "radius"),
    ],
)
def test_wrong_arguments_are_named_with_what_is_right(call, words):
    with pytest.raises(ValueError, match=words):
        call()


def bumps(mesh, places, heights, width=0.08):
    away = np.linalg.norm(mesh.vertices[:, None] - np.asarray(places), axis=2)
    return np.exp(-((away / width) ** 2)) @ np.asarray(heights)


def test_truth_points_are_the_peaks_with_the_gaze_around_them():
    places = 0.5 * np.eye(3)
    points, weights = gaze_peaks(BALL, bumps(BALL, places, [1, 3, 2]), radius=0.2)
    assert points.tolist() == [nearest(BALL, places[i]) for i in (1, 2, 0)]
    assert weights == pytest.approx([1 / 2, 1 / 3, 1 / 6], abs=0.01)


def test_a_peak_in_the_reach_of_a_higher_one_is_none_and_stray_looks_are_left_out():
    places = np.array([[0.5, 0, 0], [0.4, 0.3, 0]])  # 0.32 apart over the surface, 0.19 of the diagonal
    density = bumps(BALL, places, [2, 1])
    assert len(gaze_peaks(BALL, density, radius=0.15)[0]) == 2
    assert gaze_peaks(BALL, density, radius=0.25)[0].tolist() == [nearest(BALL, places[0])]
    stray = bumps(BALL, 0.5 * np.eye(3), [1, 1, 0.04])  # the last with 2 % of the gaze
    assert [len(gaze_peaks(BALL, stray, min_weight=least)[0]) for least in (0.05, 0.01)] == [2, 3]


def test_a_peak_below_even_attention_is_left_out():
    density = 1 + bumps(BALL, [[0.5, 0, 0], [-0.5, 0, 0]], [5, -0.5]) + bumps(BALL, [[-0.5, 0, 0]], [0.4], width=0.02)
    assert density[nearest(BALL, [-0.5, 0, 0])] < 1
    assert gaze_peaks(BALL, density, radius=0.05, min_weight=0)[0].tolist() == [nearest(BALL, [0.5, 0, 0])]


def test_truth_points_ignore_vertex_order_scale_and_unit_even_with_ties():
    draw = np.random.default_rng(2)
    density = np.minimum(bumps(BALL, 0.5 * np.eye(3), [1, 1, 1]), 0.4)  # flat tops: seven equal vertices
    order, rounding = draw.permutation(642), 1 + 1e-13 * draw.random(642)
    points, weights = gaze_peaks(BALL, density, radius=0.2)
    moved = Mesh(80 * BALL.vertices[order], np.argsort(order)[BALL.faces])
    ids, shares = gaze_peaks(moved, 1e-7 * (density * rounding)[order], radius=0.2)
    assert len(points) == 3 and set(order[ids]) == set(points)
    assert shares == pytest.approx(weights)


def test_peaks_of_few_faces_and_of_vertices_in_no_face():
    points, weights = gaze_peaks(mesh_of(trimesh.creation.box()), np.arange(8) == 5, radius=0.01)
    assert points.tolist() == [5] and weights == pytest.approx([1])  # no edge is as short as the radius
    assert gaze_peaks(ONE_FACE, [0.9, 1.0, 0.2], radius=0.01)[0].tolist() == [1]  # vertex 0 is below its neighbour
    lone = Mesh(np.r_[BALL.vertices, [[2, 2, 2]]], BALL.faces)
    density = np.r_[bumps(BALL, [[0.5, 0, 0]], [1]), 1e15]
    assert gaze_peaks(lone, density)[0].tolist() == [nearest(BALL, [0.5, 0, 0])]


def test_distances_on_a_plane_are_straight_along_edges_and_over_pairs_of_faces():
    mesh = flat_grid(9, 9)
    rows = Geodesics(mesh).distances([0])[0].reshape(9, 9)
    assert rows[0, 8] == pytest.approx(8) and rows[8, 8] == pytest.approx(8 * np.sqrt(2))
    assert rows[4, 8] == pytest.approx(4 * np.sqrt(5)) and rows[8, 4] == pytest.approx(4 * np.sqrt(5))
    limited = Geodesics(mesh).distances([0], 3)[0]
    assert limited[np.isfinite(limited)].max() <= 3 and limited[3] == 3 and np.isinf(limited[4])
    worse = Mesh(mesh.vertices, np.r_[mesh.faces, [[0, 0, 1], [3, 3, 3], [0, 1, 2], [0, 1, 2]]])  # faces without area
    assert Geodesics(worse).distances([0])[0].reshape(9, 9) == pytest.approx(rows)


def test_a_seam_does_not_cut_the_surface_but_a_gap_does():
    loose = BALL.vertices[BALL.faces].reshape(-1, 3)  # every face with corners of its own
    loose = np.where(np.arange(len(loose))[:, None] % 2, loose + 0.0, -(0.0 - loose))  # every other zero is -0.0
    torn = Mesh(loose, np.arange(len(loose)).reshape(-1, 3))
    assert Geodesics(torn).distances([0]).max() == pytest.approx(Geodesics(BALL).distances([BALL.faces[0, 0]]).max())
    assert np.isinf(Geodesics(TWO_BOXES).distances([0])[0, 8:]).all()


def test_distances_go_round_a_notch_and_along_an_edge_that_is_shorter_than_the_way_over_two_faces():
    # Two faces in the shape of an arrow: the line between the barbs leaves the surface, the way leads by its notch.
    arrow = Mesh([[0, 0, 0], [1, 0, 0], [3, 1, 0], [3, -1, 0]], [[0, 1, 2], [1, 0, 3]])
    assert Geodesics(arrow).distances([2])[0, 3] == pytest.approx(2 * np.sqrt(5))
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    tetrahedron = Mesh(corners, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    assert Geodesics(tetrahedron).distances([0])[0, 1:] == pytest.approx(np.sqrt(8))
