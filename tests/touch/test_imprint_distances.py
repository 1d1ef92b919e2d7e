"""The raw distances of the virtual pressure array against shapes whose distance is known."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import distances, sensor_axes, sensor_normals

SURFACES = {
    "plane": lambda x, y: 0 * x,
    "sphere": lambda x, y: np.sqrt(0.3**2 - x**2 - y**2),
    "cylinder": lambda x, y: np.sqrt(0.3**2 - y**2),
    "saddle": lambda x, y: 2 * x * x - 3 * y * y,
    "pit": lambda x, y: 4 * (x * x + y * y),
    "step": lambda x, y: np.where(np.abs(x) > 0.031, 0.2, 0.0),
    "pyramid": lambda x, y: -np.maximum(np.abs(x), np.abs(y)),
}
ROTATION = Rotation.from_euler("xyz", [0.4, -1.1, 2.0]).as_matrix()


@pytest.mark.parametrize("cells", [(16, 16), (15, 15), (8, 20)])
@pytest.mark.parametrize("name", SURFACES)
def test_distances_are_exact_and_negative_inside(shapes, name, cells):
    mesh, vertex = shapes.solid(SURFACES[name])
    x, y = shapes.cell_places(cells, 0.01)
    expected = SURFACES[name](0.0, 0.0) - SURFACES[name](x, y)
    assert np.allclose(distances(mesh, [vertex], cells, 0.01, max_distance=1.0)[0], expected, atol=1e-14, rtol=0)


def test_cells_off_the_object_report_max_distance(shapes):
    mesh, vertex = shapes.solid(shapes.sphere, half=12)
    found = distances(mesh, [vertex], (16, 16), 0.01)[0]
    x, y = shapes.cell_places((16, 16), 0.01)
    off = np.maximum(abs(x), abs(y)) > 0.06
    assert (found[off] == 0.16).all() and (found[~off] < 0.16).all()


def test_max_distance_bounds_the_distance_both_ways(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 20 * (x * x - y * y))
    found = distances(mesh, [vertex], (16, 16), 0.01, max_distance=0.02)
    assert found.min() == -0.02 and found.max() == 0.02


def test_turning_mesh_and_array_together_changes_nothing(shapes):
    mesh, vertex = shapes.solid(SURFACES["saddle"])
    axes = sensor_axes(sensor_normals(mesh, [vertex]))
    moved = distances(shapes.turned(mesh, ROTATION, shift=1000.0), [vertex], axes=axes @ ROTATION.T)
    assert np.allclose(moved, distances(mesh, [vertex]), atol=1e-9)


def test_turning_about_the_vertical_changes_nothing_away_from_the_poles(shapes):
    upright, vertex = shapes.solid(SURFACES["saddle"])
    upright = shapes.turned(upright, Rotation.from_euler("y", 70, degrees=True).as_matrix())
    around = Rotation.from_euler("z", 131, degrees=True).as_matrix()
    assert np.allclose(distances(shapes.turned(upright, around), [vertex]), distances(upright, [vertex]), atol=1e-9)


def test_distances_scale_with_mesh_and_pitch(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    small = shapes.turned(mesh, np.eye(3), scale=0.01)
    assert np.allclose(distances(small, [vertex], pitch=1e-4), 0.01 * distances(mesh, [vertex], pitch=0.01), atol=1e-11)


def test_order_of_vertices_faces_and_corners_does_not_matter(shapes):
    mesh, vertex = shapes.solid(SURFACES["saddle"])
    random = np.random.default_rng(0)
    order = random.permutation(len(mesh.vertices))
    place = np.argsort(order)
    faces = np.roll(place[mesh.faces][random.permutation(len(mesh.faces))], 1, axis=1)
    touched = [vertex, 40, 900]
    found = distances(Mesh(mesh.vertices[order], faces), place[touched])
    assert np.allclose(found, distances(mesh, touched), atol=1e-9)


def test_row_0_is_up_and_column_0_left_seen_from_outside(shapes):
    mesh, vertex = shapes.solid(lambda x, y: np.where((x > 0.02) & (y > 0.02), -0.05, 0.0))
    low = distances(mesh, [vertex])[0] > 0.04  # normal +z: up is +y, right is +x
    assert low[:5, -5:].all() and not low[6:].any() and not low[:, :10].any()
    wall = shapes.turned(
        mesh, Rotation.from_euler("xz", [90, 90], degrees=True).as_matrix()
    )  # the top looks along +x, its +y up
    assert np.allclose(sensor_axes(sensor_normals(wall, [vertex]))[0], [[0, 1, 0], [0, 0, 1], [1, 0, 0]])
    assert np.allclose(distances(wall, [vertex]), distances(mesh, [vertex]), atol=1e-9)


def test_axes_are_right_handed_and_perpendicular_everywhere():
    normals = np.random.default_rng(1).normal(size=(500, 3))
    normals = np.r_[normals, np.eye(3), -np.eye(3)]
    axes = sensor_axes(normals / np.linalg.norm(normals, axis=1)[:, None])
    assert np.allclose(axes @ axes.transpose(0, 2, 1), np.eye(3)) and np.allclose(np.linalg.det(axes), 1)


def test_normal_counts_faces_alike_whatever_their_size():
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 9.0]])
    mesh = Mesh(corners, [[0, 1, 2], [0, 2, 3]])  # normals +z (area 1/2) and +x (area 9/2)
    assert np.allclose(sensor_normals(mesh, [0]), np.sqrt([[0.5, 0, 0.5]]))


def test_thin_plate_is_felt_only_on_its_near_side(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 0 * x, depth=1e-4)
    assert np.allclose(distances(mesh, [vertex]), 0, atol=1e-9)


def test_back_of_a_lone_sheet_counts_as_surface_below(shapes):
    patch, vertex = shapes.solid(lambda x, y: 0 * x, half=3, depth=0.01)
    sheet = [[-1, -1, -0.1], [1, -1, -0.1], [0, 1, -0.1]]
    n = len(patch.vertices)
    mesh = Mesh(np.r_[patch.vertices, sheet], np.r_[patch.faces, [[n, n + 2, n + 1]]])  # it looks away from the array
    assert np.allclose(distances(mesh, [vertex])[0][[0, -1]], 0.1)


def test_open_mesh_touched_on_its_inside_feels_nothing_below():
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, -1, 0]], [[0, 1, 2], [0, 2, 3], [0, 3, 1]])
    below = Mesh(mesh.vertices, mesh.faces[:, ::-1])
    assert np.allclose(distances(mesh, [0]), 0, atol=1e-9) and np.allclose(distances(below, [0]), 0, atol=1e-9)


@pytest.mark.parametrize(
    "change, words",
    [
        ({"cells": (0, 16)}, "cells must be"),
        ({"cells": (16,)}, "cells must be"),
        ({"cells": (2.5, 4)}, "cells must be"),
        ({"pitch": 0.0}, "pitch must be"),
        ({"pitch": np.nan}, "pitch must be"),
        ({"max_distance": -1.0}, "max_distance must be"),
        ({"vertices": [7]}, "vertex 7 is not in the mesh"),
        ({"vertices": [-1]}, "vertex -1 is not in the mesh"),
        ({"vertices": [0.5]}, "whole numbers"),
        ({"vertices": 3}, "shape"),
        ({"vertices": [0, 4]}, "vertex 4 has no normal"),
        ({"vertices": [5]}, "vertex 5 has no normal"),
        ({"axes": np.zeros((1, 3, 3))}, "perpendicular"),
        ({"axes": np.eye(3)}, "shape"),
        ({"axes": np.diag([-1.0, 1, 1])[None]}, "right x up"),
        ({"cells": (np.nan, 4)}, "cells must be"),
        ({"cells": (4, np.inf)}, "cells must be"),
    ],
)
def test_what_makes_no_touch_is_named(change, words):
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [5, 5, 5], [1, 1, 0], [2, 1, 0]]
    faces = [[0, 1, 2], [0, 2, 3], [5, 6, 1], [5, 1, 6]]  # vertex 4 is in no face, the faces of vertex 5 cancel out
    with pytest.raises(ValueError, match=words):
        distances(Mesh(corners, faces), **{"vertices": [0], **change})


def test_no_vertices_give_no_imprints(shapes):
    mesh, _ = shapes.solid(shapes.sphere)
    assert distances(mesh, np.zeros(0, dtype=int), (4, 5)).shape == (0, 4, 5)
