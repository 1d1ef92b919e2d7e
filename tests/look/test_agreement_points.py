"""Agreement of interest points: the errors of Dutagaci et al. (2012), ground-truth points and distances on surfaces."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.agreement import TOLERANCES, gaze_peaks, interest_point_errors
from haptic_glance.look.agreement.geodesic import Geodesics
from haptic_glance.mesh.mesh import Mesh


def as_mesh(shape):
    return Mesh(shape.vertices, shape.faces)


BALL = as_mesh(trimesh.creation.icosphere(3, radius=0.5))
ONE_FACE = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])


def grid(n):
    """A flat square of n x n vertices one apart; vertex i lies at (i % n, i // n)."""
    y, x = np.divmod(np.arange(n * n), n)
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.r_[np.stack([corner, corner + 1, corner + n + 1], 1), np.stack([corner, corner + n + 1, corner + n], 1)]
    return Mesh(np.stack([x, y, 0 * x], axis=1), faces)


def nearest(mesh, place):
    return int(np.argmin(np.linalg.norm(mesh.vertices - place, axis=1)))


def test_detecting_the_truth_has_no_errors_at_any_tolerance():
    points = np.array([3, 77, 200, 410])
    errors = interest_point_errors(BALL, points[::-1], points, [4, 1, 1, 2])
    assert all((error == 0).all() for error in errors.values())


def test_errors_fall_as_the_tolerance_grows():
    draw = np.random.default_rng(0)
    for _ in range(10):
        points, detected = draw.choice(642, 12, replace=False), draw.choice(642, 30, replace=False)
        errors = interest_point_errors(BALL, detected, points, draw.random(12))
        for error in errors.values():
            assert (np.diff(error) <= 0).all() and error[0] > error[-1]
            assert (error >= 0).all() and (error <= 1).all()


def test_errors_worked_out_by_hand():
    # On a line of a grid: people at x = 0 (3 of them) and x = 10 (1); detected at x = 2, 3 and 11. Diagonal 20 sqrt(2).
    mesh = grid(21)
    errors = interest_point_errors(mesh, [2, 3, 11], [0, 10], [3, 1], np.array([0.9, 1, 1.9, 2, 9]) / mesh.diagonal)
    assert errors["fne"] == pytest.approx([1, 0.5, 0.5, 0, 0])
    assert errors["fpe"] == pytest.approx([1, 2 / 3, 2 / 3, 1 / 3, 1 / 3])  # x = 2 and 3 find one point together
    assert errors["wme"] == pytest.approx([1, 3 / 4, 3 / 4, 0, 0])


def test_a_detected_vertex_finds_only_its_nearest_point():
    mesh = grid(21)
    errors = interest_point_errors(mesh, [4], [0, 10], tolerances=[8 / mesh.diagonal])
    assert errors["fne"] == [0.5] and errors["fpe"] == [0]


def test_a_vertex_detected_twice_counts_once():
    assert interest_point_errors(BALL, [0, 0, 0, 5], [0])["fpe"][0] == 0.5


def test_a_tolerance_of_whole_edges_reaches_their_end():
    mesh = Mesh(0.1 * grid(21).vertices, grid(21).faces)  # in floats three edges are longer than 0.3
    for edges in range(1, 21):
        assert interest_point_errors(mesh, [edges], [0], tolerances=[edges / 20 / np.sqrt(2)])["fne"] == [0]


def test_of_two_points_as_near_the_heavier_is_found_whatever_their_order():
    mesh = grid(21)
    for points, weights in (([0, 10], [1, 3]), ([10, 0], [3, 1])):
        assert interest_point_errors(mesh, [5], points, weights, [6 / mesh.diagonal])["wme"] == [0.25]


def test_weights_may_differ_by_tolerance():
    mesh = grid(21)
    weights = [[1, 1], [1, 3]]
    errors = interest_point_errors(mesh, [0], [0, 10], weights, [0, 2 / mesh.diagonal])
    assert errors["wme"] == pytest.approx([1 / 2, 3 / 4])


def test_no_detection_misses_everything_and_claims_nothing_wrong():
    errors = interest_point_errors(BALL, [], [1, 2])
    assert (errors["fne"] == 1).all() and (errors["wme"] == 1).all() and (errors["fpe"] == 0).all()


def test_a_detection_on_another_piece_is_wrong():
    two = as_mesh(
        trimesh.util.concatenate([trimesh.creation.box(), trimesh.creation.box().apply_translation([3, 0, 0])])
    )
    errors = interest_point_errors(two, [8], [0])
    assert (errors["fne"] == 1).all() and (errors["fpe"] == 1).all()


@pytest.mark.parametrize("change", ["order", "scale"])
def test_errors_ignore_vertex_order_and_scale(change):
    draw = np.random.default_rng(1)
    points, detected, weights = draw.choice(642, 9, False), draw.choice(642, 20, False), draw.random(9)
    order = draw.permutation(642) if change == "order" else np.arange(642)
    back = np.argsort(order)  # vertex i becomes back[i]
    moved = Mesh(BALL.vertices[order] * (1 if change == "order" else 250), back[BALL.faces])
    before = interest_point_errors(BALL, detected, points, weights)
    after = interest_point_errors(moved, back[detected], back[points], weights)
    assert all(after[name] == pytest.approx(before[name]) for name in before)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (([0], []), "points"),
        (([0], [1, 1]), "points"),
        (([0], [642]), "points"),
        (([-1], [1]), "detected"),
        (([0.5], [1]), "detected"),
        (([0], [1, 2], [1]), "weights"),
        (([0], [1, 2], [1, -1]), "weights"),
        (([0], [1, 2], [0, 0]), "weights"),
        (([0], [1], None, [-0.1]), "tolerances"),
        (([0], [1], None, [np.nan]), "tolerances"),
    ],
)
def test_bad_input_is_named(arguments, named):
    with pytest.raises(ValueError, match=named):
        interest_point_errors(BALL, *arguments)


def test_tolerances_are_those_of_the_paper():
    assert TOLERANCES[0] == 0 and TOLERANCES[-1] == 0.12


def bumps(mesh, places, heights, width=0.08):
    away = np.linalg.norm(mesh.vertices[:, None] - np.asarray(places), axis=2)
    return np.exp(-((away / width) ** 2)) @ np.asarray(heights)


def test_truth_points_are_the_peaks_with_the_gaze_around_them():
    places = 0.5 * np.eye(3)
    points, weights = gaze_peaks(BALL, bumps(BALL, places, [1, 3, 2]), radius=0.2)
    assert points.tolist() == [nearest(BALL, places[i]) for i in (1, 2, 0)]
    assert weights == pytest.approx([1 / 2, 1 / 3, 1 / 6], abs=0.01)


def test_a_peak_in_the_reach_of_a_higher_one_is_none():
    places = np.array([[0.5, 0, 0], [0.4, 0.3, 0]])  # 0.32 apart over the surface, 0.19 of the diagonal
    density = bumps(BALL, places, [2, 1])
    assert len(gaze_peaks(BALL, density, radius=0.15)[0]) == 2
    assert gaze_peaks(BALL, density, radius=0.25)[0].tolist() == [nearest(BALL, places[0])]


def test_stray_looks_are_left_out():
    density = bumps(BALL, 0.5 * np.eye(3), [1, 1, 0.04])  # the last with 2 % of the gaze
    assert len(gaze_peaks(BALL, density, min_weight=0.05)[0]) == 2
    assert len(gaze_peaks(BALL, density)[0]) == 3


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
    found, shares = gaze_peaks(moved, 1e-7 * (density * rounding)[order], radius=0.2)
    assert len(points) == 3 and set(order[found]) == set(points)
    assert shares == pytest.approx(weights)


def test_a_peak_is_found_where_no_edge_is_as_short_as_the_radius():
    box = as_mesh(trimesh.creation.box())
    points, weights = gaze_peaks(box, np.arange(8) == 5, radius=0.01)
    assert points.tolist() == [5] and weights == pytest.approx([1])


def test_a_vertex_below_its_neighbour_is_no_peak_even_beyond_the_radius():
    assert gaze_peaks(ONE_FACE, [0.9, 1.0, 0.2], radius=0.01)[0].tolist() == [1]


def test_density_at_a_vertex_in_no_face_is_no_point():
    lone = Mesh(np.r_[BALL.vertices, [[2, 2, 2]]], BALL.faces)
    density = np.r_[bumps(BALL, [[0.5, 0, 0]], [1]), 1e15]
    assert gaze_peaks(lone, density)[0].tolist() == [nearest(BALL, [0.5, 0, 0])]


@pytest.mark.parametrize(
    ("density", "named"),
    [(np.ones(641), "642"), (np.full(642, np.nan), "finite"), (-np.ones(642), "negative")]
    + [(np.zeros(642), "empty"), (np.full(642, 0.1), "uniform")],
)
def test_a_density_without_peaks_is_an_error_that_says_why(density, named):
    with pytest.raises(ValueError, match=named):
        gaze_peaks(BALL, density)


def test_bad_meshes_give_defined_answers():
    assert interest_point_errors(ONE_FACE, [1], [0])["fne"].tolist() == [1] * 13
    assert gaze_peaks(ONE_FACE, [0.0, 1.0, 0.5])[0].tolist() == [1]
    bare = Mesh(np.zeros((3, 3)), np.zeros((0, 3), dtype=int))
    assert interest_point_errors(bare, [1], [0])["fne"].tolist() == [0] * 13  # all at one place
    with pytest.raises(ValueError, match="empty"):
        gaze_peaks(bare, np.ones(3))


def test_distances_on_a_plane_are_straight_along_edges_and_over_pairs_of_faces():
    mesh = grid(9)
    found = Geodesics(mesh).distances([0])[0].reshape(9, 9)
    assert found[0, 8] == pytest.approx(8) and found[8, 8] == pytest.approx(8 * np.sqrt(2))
    assert found[4, 8] == pytest.approx(4 * np.sqrt(5)) and found[8, 4] == pytest.approx(4 * np.sqrt(5))


def test_distances_are_never_shorter_than_straight_and_hardly_longer():
    draw = np.random.default_rng(0)
    flat = grid(30)
    mesh = Mesh(flat.vertices + np.c_[draw.uniform(-0.3, 0.3, (900, 2)), np.zeros(900)], flat.faces)
    true = np.linalg.norm(mesh.vertices[:10, None] - mesh.vertices, axis=2)
    ratio = (Geodesics(mesh).distances(np.arange(10)) / np.where(true > 5, true, np.nan))[true > 5]
    assert ratio.min() >= 1 - 1e-12 and ratio.mean() < 1.03 and ratio.max() < 1.15


def test_distances_over_a_sphere_are_arcs():
    unit = BALL.vertices / 0.5
    true = 0.5 * np.arccos(np.clip(unit[:20] @ unit.T, -1, 1))
    ratio = (Geodesics(BALL).distances(np.arange(20)) / np.where(true > 0.2, true, np.nan))[true > 0.2]
    assert 1 < ratio.mean() < 1.025 and ratio.min() > 0.99 and ratio.max() < 1.08


def test_a_seam_does_not_cut_the_surface_but_a_gap_does():
    loose = BALL.vertices[BALL.faces].reshape(-1, 3)  # every face with corners of its own
    loose = np.where(np.arange(len(loose))[:, None] % 2, loose + 0.0, -(0.0 - loose))  # every other zero is -0.0
    torn = Mesh(loose, np.arange(len(loose)).reshape(-1, 3))
    assert np.signbit(loose[loose == 0]).any() and not np.signbit(loose[loose == 0]).all()
    assert Geodesics(torn).distances([0]).max() == pytest.approx(Geodesics(BALL).distances([BALL.faces[0, 0]]).max())
    two = as_mesh(
        trimesh.util.concatenate([trimesh.creation.box(), trimesh.creation.box().apply_translation([3, 0, 0])])
    )
    assert np.isinf(Geodesics(two).distances([0])[0, 8:]).all()


def test_distances_go_round_a_notch():
    # Two faces in the shape of an arrow: the line between the barbs leaves the surface, the way leads by its notch.
    arrow = Mesh([[0, 0, 0], [1, 0, 0], [3, 1, 0], [3, -1, 0]], [[0, 1, 2], [1, 0, 3]])
    assert Geodesics(arrow).distances([2])[0, 3] == pytest.approx(2 * np.sqrt(5))


def test_distances_take_the_edge_where_it_is_shorter_than_the_way_over_two_faces():
    corners = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    tetrahedron = Mesh(corners, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    assert Geodesics(tetrahedron).distances([0])[0, 1:] == pytest.approx(np.sqrt(8))


def test_faces_without_area_do_not_disturb_distances():
    mesh = grid(9)
    worse = Mesh(mesh.vertices, np.r_[mesh.faces, [[0, 0, 1], [3, 3, 3], [0, 1, 2], [0, 1, 2]]])
    assert Geodesics(worse).distances([0]) == pytest.approx(Geodesics(mesh).distances([0]))


def test_distances_end_at_the_limit():
    found = Geodesics(grid(9)).distances([0], 3)[0]
    assert found[np.isfinite(found)].max() <= 3 and found[3] == 3 and np.isinf(found[4])
