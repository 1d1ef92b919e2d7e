"""A rigid array, one that shrinks at a saddle, and the older sensor of quasi-tangent planes."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.axes import to_z_up
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import (
    CONTACTS,
    Surface,
    adaptive_distances,
    contour_imprints,
    distances,
    distances_at,
    normalise,
    quasi_tangent,
    sensor_axes,
    sensor_normals,
)
from haptic_glance.touch.quasi_tangent import SENSORS, touch

FLAT = np.eye(3)[None]  # right +x, up +y, normal +z


def boxes(*extents_and_middles):
    """Closed boxes side by side as one mesh."""
    parts = [
        trimesh.creation.box(extents, trimesh.transformations.translation_matrix(at))
        for extents, at in extents_and_middles
    ]
    whole = trimesh.util.concatenate(parts)
    return Mesh(whole.vertices, whole.faces)


def cup(inner, depth):
    """A square cup: its floor's inside is at z = 0, its walls are 0.1 thick and `depth` high."""
    wide = inner + 0.2
    return boxes(
        ((wide, wide, 0.1), (0, 0, -0.05)),
        ((0.1, wide, depth), (inner / 2 + 0.05, 0, depth / 2)),
        ((0.1, wide, depth), (-inner / 2 - 0.05, 0, depth / 2)),
        ((inner, 0.1, depth), (0, inner / 2 + 0.05, depth / 2)),
        ((inner, 0.1, depth), (0, -inner / 2 - 0.05, depth / 2)),
    )


def test_on_a_convex_top_it_feels_what_the_tangent_array_feels(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    rigid = distances(mesh, [vertex], (15, 15), 0.01, contact="rigid")
    assert np.allclose(rigid, distances(mesh, [vertex], (15, 15), 0.01), atol=1e-14)


def test_on_a_saddle_it_rests_on_the_ridge_and_no_cell_is_inside(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 2 * x * x - 3 * y * y)
    tangent = distances(mesh, [vertex], (16, 16), 0.01)
    rigid = distances(mesh, [vertex], (16, 16), 0.01, contact="rigid")
    assert tangent.min() < 0 and rigid.min() == 0
    assert np.allclose(rigid, tangent - tangent.min(), atol=1e-14)


def test_it_rests_on_what_hangs_over_the_place_and_the_tangent_array_does_not_feel_it():
    shelf = boxes(((1, 1, 0.2), (0, 0, -0.1)), ((0.2, 1, 0.02), (0.3, 0, 0.1)))  # a board 0.09 over the right part
    at = dict(cells=(8, 8), pitch=0.1, max_distance=0.5)
    tangent = distances_at(Surface(shelf), np.zeros((1, 3)), FLAT, **at)[0]
    rigid = distances_at(Surface(shelf), np.zeros((1, 3)), FLAT, **at, contact="rigid")[0]
    assert np.allclose(tangent, 0, atol=1e-15)
    assert np.allclose(rigid[:, 6:], 0) and np.allclose(rigid[:, :6], 0.11, atol=1e-14)


def test_over_a_narrow_shallow_cup_it_rests_on_the_rim_and_in_a_wide_one_on_the_floor():
    lengths = distances_at(Surface(cup(0.5, 0.1)), np.zeros((1, 3)), FLAT, (14, 14), 0.05, contact="rigid")[0]
    assert np.allclose(lengths[[0, -1]], 0, atol=1e-14) and np.allclose(lengths[3:-3, 3:-3], 0.1, atol=1e-14)
    wide = distances_at(Surface(cup(0.5, 0.4)), np.zeros((1, 3)), FLAT, (8, 8), 0.05, contact="rigid")
    assert np.allclose(wide, 0, atol=1e-14)


def test_in_a_cup_narrower_than_the_array_and_deeper_than_the_sensing_depth_it_stays_where_it_starts():
    lengths = distances_at(Surface(cup(0.5, 3.0)), np.zeros((1, 3)), FLAT, (14, 14), 0.05, contact="rigid")[0]
    assert np.allclose(lengths[[0, -1]], 0) and np.allclose(lengths[3:-3, 3:-3], 0.7)  # the floor is max_distance away


def test_between_cells_the_place_itself_carries_it():
    spike = trimesh.creation.cone(0.04, 0.5, transform=trimesh.transformations.translation_matrix((0, 0, -0.5)))
    floor = boxes(((1, 1, 0.1), (0, 0, -0.45)))
    whole = trimesh.util.concatenate([spike, trimesh.Trimesh(floor.vertices, floor.faces)])
    lengths = distances_at(
        Surface(Mesh(whole.vertices, whole.faces)), np.zeros((1, 3)), FLAT, (2, 2), 0.1, 1.0, "rigid"
    )
    assert np.allclose(lengths, 0.4, atol=1e-12)  # no cell meets the spike, whose tip is the place


def test_without_contact_every_cell_reports_max_distance():
    lengths = distances_at(Surface(boxes(((1, 1, 1), (0, 0, 0)))), [[9.0, 0, 0]], FLAT, (4, 4), 0.1, contact="rigid")
    assert (lengths == 0.4).all()


def test_depth_is_limited_from_where_it_rests(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 20 * (x * x - y * y))
    lengths = distances(mesh, [vertex], (16, 16), 0.01, max_distance=0.02, contact="rigid")
    assert lengths.min() == 0 and lengths.max() == 0.02


def pitches(*array):
    return adaptive_distances(*array)[0]


def at(mesh, vertex):
    return mesh.vertices[[vertex]], sensor_axes(sensor_normals(mesh, [vertex]))


@pytest.mark.parametrize("cells", [(15, 15), (8, 16)])
def test_at_a_saddle_it_shrinks_to_what_fits_and_no_further(shapes, cells):
    mesh, vertex = shapes.solid(lambda x, y: 2 * x * x - 3 * y * y, half=40, spacing=0.0025)
    place = at(mesh, vertex)
    (pitch,) = pitches(mesh, *place, cells, 0.01)
    assert 0.002 < pitch < 0.01
    assert distances_at(mesh, *place, cells, pitch).min() >= -0.005
    assert distances_at(mesh, *place, cells, pitch * 1.05).min() < -0.005


def test_it_keeps_its_size_where_it_fits_and_ends_at_the_least_even_where_that_does_not(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    assert pitches(mesh, *at(mesh, vertex), (16, 16), 0.01).tolist() == [0.01]
    assert pitches(mesh, np.zeros((0, 3)), np.zeros((0, 3, 3))).shape == (0,)
    mesh, vertex = shapes.solid(lambda x, y: 30 * np.abs(x), spacing=0.002)
    assert pitches(mesh, *at(mesh, vertex), (16, 16), 0.01).tolist() == [0.002]


def test_each_array_is_judged_for_itself(shapes):
    saddle, vertex = shapes.solid(lambda x, y: 2 * x * x - 3 * y * y)
    centres, axes = (np.repeat(part, 3, axis=0) for part in at(saddle, vertex))
    together = pitches(saddle, centres, axes, (16, 16), np.array([0.002, 0.01, 0.02]))
    alone = [pitches(saddle, *at(saddle, vertex), (16, 16), pitch)[0] for pitch in (0.002, 0.01, 0.02)]
    assert together.tolist() == alone and together[0] == 0.002


def test_distances_are_those_of_the_array_at_its_size(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 2 * x * x - 3 * y * y, half=20, spacing=0.003)  # narrower than the array
    place = at(mesh, vertex)
    pitch, measured = adaptive_distances(mesh, *place, (16, 16), 0.01)
    assert pitch[0] < 0.01
    np.testing.assert_array_equal(measured, distances_at(mesh, *place, (16, 16), pitch))


def fan(angles, heights, radius=0.01):
    """Vertex 0 at the origin amid a ring at these angles (degrees) and heights, closer neighbours first."""
    turns = np.radians(angles)
    away = radius * (1 + 0.01 * np.arange(len(angles)))
    ring = np.c_[away * np.cos(turns), away * np.sin(turns), heights]
    order = 1 + np.argsort(np.mod(angles, 360))
    faces = [[0, a, b] for a, b in zip(order, np.roll(order, -1), strict=True)]
    return Mesh(np.r_[[[0, 0, 0]], ring], faces)


def test_the_plane_holds_the_three_closest_neighbours():
    mesh = fan([0, 120, 240, 60, 180, 300], [-0.001, -0.002, -0.003, 0.004, 0.004, 0.004])
    centres, axes = quasi_tangent(mesh, [0])
    assert np.allclose((mesh.vertices[1:4] - centres[0]) @ axes[0, 2], 0, atol=1e-15) and axes[0, 2, 2] > 0
    assert np.allclose(np.cross(mesh.vertices[0] - centres[0], axes[0, 2]), 0, atol=1e-15)


def test_a_third_neighbour_in_one_line_gives_way_to_the_next():
    mesh = fan([0, 180, 0.0001, 90, 270], [0, 0, 0, -0.002, 0.1])
    _, axes = quasi_tangent(mesh, [0])
    assert np.allclose((mesh.vertices[[2, 4]] - mesh.vertices[1]) @ axes[0, 2], 0, atol=1e-9)


def test_a_vertex_of_two_neighbours_takes_the_third_from_two_edges_away():
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.5]]
    centres, axes = quasi_tangent(Mesh(corners, [[0, 1, 2], [1, 3, 2]]), [0])
    assert np.allclose((np.array(corners[1:]) - centres[0]) @ axes[0, 2], 0)


def test_neighbours_that_span_no_plane_are_named():
    with pytest.raises(ValueError, match="around vertex 0 no three neighbours span a plane"):
        contour_imprints(Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), [0])
    with pytest.raises(ValueError, match="vertex 3 has no normal"):
        contour_imprints(Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]], [[0, 1, 2]]), [3])


def test_a_cell_s_pressure_counts_the_planes_that_meet_the_object(shapes):
    mesh, vertex = shapes.solid(lambda x, y: -np.round(np.abs(x) / 0.005) * 0.004)  # flat along y, a roof along x
    centres, axes = quasi_tangent(mesh, [vertex])
    image = contour_imprints(mesh, [vertex], (15, 15), 0.02)[0]  # planes 0.005 apart
    assert image.dtype == np.float32 and set(np.unique(image * 16)) <= set(range(17))
    down = distances_at(mesh, centres, axes, (15, 15), 0.02)[0]
    for i, j in ((7, 7), (3, 2), (14, 9)):
        met = sum(down[i, j] <= depth + 1e-9 for depth in np.arange(16) * 0.005)
        assert image[i, j] == pytest.approx(1 - met / 16)


def test_contours_do_not_depend_on_the_axis_that_points_up():
    ball = trimesh.creation.icosphere(2)
    upright = Mesh(ball.vertices * [1, 0.8, 0.6], ball.faces)
    lying = Mesh(upright.vertices @ to_z_up("y"), ball.faces, up="y")
    vertices = np.arange(0, len(ball.vertices), 5)
    expected = contour_imprints(upright, vertices, pitch=0.02)
    np.testing.assert_array_equal(contour_imprints(lying, vertices, pitch=0.02), expected)


def test_a_wall_thinner_than_the_depth_presses_like_a_thick_one(shapes):
    thin, vertex = shapes.solid(shapes.sphere)
    shell = Mesh(np.r_[thin.vertices[:2401], thin.vertices[:2401] - [0, 0, 0.004]], thin.faces)
    assert np.array_equal(contour_imprints(shell, [vertex]), contour_imprints(thin, [vertex]))


@pytest.mark.parametrize(("change", "words"), [({"cells": (0, 1)}, "cells must be"), ({"pitch": 0.0}, "pitch must be")])
def test_what_makes_no_sensor_is_named(shapes, change, words):
    mesh, vertex = shapes.solid(shapes.sphere, half=4)
    with pytest.raises(ValueError, match=words):
        adaptive_distances(mesh, *at(mesh, vertex), **change)


CELLS, PITCH = (16, 16), 0.01


@pytest.fixture(scope="module")
def ball():
    made = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
    loose = [[2.0, 0, 0], [2.1, 0, 0], [2.2, 0, 0]]  # a face without area at the end
    return Mesh(np.r_[made.vertices, loose], np.r_[made.faces, [[len(made.vertices) + k for k in range(3)]]])


@pytest.mark.parametrize("contact", CONTACTS)
def test_the_array_feels_its_distances(ball, contact):
    felt = touch(Surface(ball), [0, 5], CELLS, PITCH, contact)
    expected = distances(ball, [0, 5], CELLS, PITCH, contact=contact)
    np.testing.assert_array_equal(felt.depths, expected)
    np.testing.assert_array_equal(felt.images, normalise(expected, PITCH))
    assert felt.depths.max() <= felt.reach


@pytest.mark.parametrize("sensor", SENSORS)
def test_where_a_sensor_cannot_touch_it_says_so(ball, sensor):
    felt = touch(Surface(ball), [0, len(ball.vertices) - 2, 5], CELLS, PITCH, sensor)
    assert felt.can.tolist() == [True, False, True] and len(felt.images) == len(felt.depths) == 2


def test_vertices_at_one_place_have_one_normal_and_a_mesh_without_them_keeps_its_bits():
    ball = trimesh.creation.icosphere(2, radius=0.5)
    vertices, faces = np.asarray(ball.vertices), np.asarray(ball.faces)
    soup = Mesh(vertices[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3))
    whole = sensor_normals(Mesh(vertices, faces), faces.ravel())
    assert sensor_normals(soup, np.arange(faces.size)) == pytest.approx(whole, abs=1e-12)
    lonely = Mesh(np.vstack([vertices, vertices[:1]]), faces)  # a vertex of no face
    first = np.unique(faces, return_index=True)[1]
    assert np.array_equal(sensor_normals(lonely, np.arange(len(vertices))), whole[first])
    with pytest.raises(ValueError, match="has no normal"):
        sensor_normals(lonely, [len(vertices)])


def test_the_two_sides_of_a_sheet_keep_their_own_normals():
    """A leaf or a card, whose sides have vertices of their own at the same places."""
    ball = trimesh.creation.icosphere(1)
    vertices, faces = np.asarray(ball.vertices), np.asarray(ball.faces)
    sheet = Mesh(np.concatenate([vertices, vertices]), np.concatenate([faces, faces[:, ::-1] + len(vertices)]))
    out, inwards = np.split(sensor_normals(sheet, np.arange(2 * len(vertices))), 2)
    assert out == pytest.approx(vertices, abs=0.05) and inwards == pytest.approx(-out)


@pytest.mark.parametrize("length", [1e-200, 1e-310, 1e200, 1e307])
def test_normals_of_any_length_have_axes(length):
    normals = np.array([[0.6, 0.0, 0.8], [1.0, 2.0, -2.0]])
    assert sensor_axes(length * normals) == pytest.approx(sensor_axes(normals), abs=1e-12)
