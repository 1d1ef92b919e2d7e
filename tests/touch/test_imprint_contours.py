"""The older sensor of quasi-tangent planes."""

import numpy as np
import pytest

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import contour_imprints, distances_at, quasi_tangent


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


def test_a_flat_place_presses_all_planes(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 0.1 * x + 0.2 * y)
    assert (contour_imprints(mesh, [vertex]) == 0).all()


def test_a_cell_s_pressure_counts_the_planes_that_meet_the_object(shapes):
    mesh, vertex = shapes.solid(lambda x, y: -np.round(np.abs(x) / 0.005) * 0.004)  # flat along y, a roof along x
    centres, axes = quasi_tangent(mesh, [vertex])
    image = contour_imprints(mesh, [vertex], (15, 15), 0.01, planes=8, depth=0.07)[0]
    assert image.dtype == np.float32 and set(np.unique(image * 8)) <= set(range(9))
    down = distances_at(mesh, centres, axes, (15, 15), 0.01)[0]
    for i, j in ((7, 7), (3, 2), (14, 9)):
        met = sum(down[i, j] <= depth + 1e-9 for depth in np.arange(8) * 0.01)
        assert image[i, j] == pytest.approx(1 - met / 8)


def test_more_planes_tell_finer_depths_and_one_plane_tells_contact_alone(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    levels = [len(np.unique(contour_imprints(mesh, [vertex], (15, 15), planes=planes))) for planes in (1, 4, 32)]
    assert levels[0] == 2 and levels[0] < levels[1] < levels[2]


def test_a_wall_thinner_than_the_depth_presses_like_a_thick_one(shapes):
    thin, vertex = shapes.solid(shapes.sphere)
    shell = Mesh(np.r_[thin.vertices[:2401], thin.vertices[:2401] - [0, 0, 0.004]], thin.faces)
    assert np.array_equal(contour_imprints(shell, [vertex]), contour_imprints(thin, [vertex]))


@pytest.mark.parametrize(
    "change, words", [({"planes": 0}, "planes"), ({"planes": 2.5}, "planes"), ({"depth": 0}, "depth")]
)
def test_what_makes_no_sensor_is_named(shapes, change, words):
    mesh, vertex = shapes.solid(shapes.sphere, half=4)
    with pytest.raises(ValueError, match=f"{words} must be"):
        contour_imprints(mesh, [vertex], **change)


def test_no_vertices_give_no_imprints(shapes):
    mesh, _ = shapes.solid(shapes.sphere, half=4)
    assert contour_imprints(mesh, np.zeros(0, int), (4, 5)).shape == (0, 4, 5)
