"""A rigid array: it rests on the first point that it meets."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, distances, distances_at, press

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


@pytest.mark.parametrize("cells", [(16, 16), (15, 15)])
def test_on_a_saddle_it_rests_on_the_ridge_and_no_cell_is_inside(shapes, cells):
    mesh, vertex = shapes.solid(lambda x, y: 2 * x * x - 3 * y * y)
    tangent = distances(mesh, [vertex], cells, 0.01)
    rigid = distances(mesh, [vertex], cells, 0.01, contact="rigid")
    assert tangent.min() < 0 and rigid.min() == 0
    assert np.allclose(rigid, tangent - tangent.min(), atol=1e-14)


def test_after_normalisation_both_are_one_where_one_surface_covers_the_array(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 2 * x * x - 3 * y * y)
    assert np.allclose(press(mesh, vertex, contact="rigid"), press(mesh, vertex), atol=1e-6)


def test_it_rests_on_what_hangs_over_the_place_and_the_tangent_array_does_not_feel_it():
    shelf = boxes(((1, 1, 0.2), (0, 0, -0.1)), ((0.2, 1, 0.02), (0.3, 0, 0.1)))  # a board 0.09 over the right part
    at = dict(cells=(8, 8), pitch=0.1, max_distance=0.5)
    tangent = distances_at(Surface(shelf), np.zeros((1, 3)), FLAT, **at)[0]
    rigid = distances_at(Surface(shelf), np.zeros((1, 3)), FLAT, **at, contact="rigid")[0]
    assert np.allclose(tangent, 0, atol=1e-15)
    assert np.allclose(rigid[:, 6:], 0) and np.allclose(rigid[:, :6], 0.11, atol=1e-14)


def test_in_a_wide_cup_it_rests_on_the_floor():
    found = distances_at(Surface(cup(0.5, 0.4)), np.zeros((1, 3)), FLAT, (8, 8), 0.05, contact="rigid")
    assert np.allclose(found, 0, atol=1e-14)


def test_over_a_narrow_shallow_cup_it_rests_on_the_rim():
    found = distances_at(Surface(cup(0.5, 0.1)), np.zeros((1, 3)), FLAT, (14, 14), 0.05, contact="rigid")[0]
    assert np.allclose(found[[0, -1]], 0, atol=1e-14) and np.allclose(found[3:-3, 3:-3], 0.1, atol=1e-14)


def test_in_a_cup_narrower_than_the_array_and_deeper_than_the_sensing_depth_it_stays_where_it_starts():
    found = distances_at(Surface(cup(0.5, 3.0)), np.zeros((1, 3)), FLAT, (14, 14), 0.05, contact="rigid")[0]
    assert np.allclose(found[[0, -1]], 0) and np.allclose(found[3:-3, 3:-3], 0.7)  # the floor is max_distance away


def test_between_cells_the_place_itself_carries_it():
    spike = trimesh.creation.cone(0.04, 0.5, transform=trimesh.transformations.translation_matrix((0, 0, -0.5)))
    floor = boxes(((1, 1, 0.1), (0, 0, -0.45)))
    whole = trimesh.util.concatenate([spike, trimesh.Trimesh(floor.vertices, floor.faces)])
    found = distances_at(Surface(Mesh(whole.vertices, whole.faces)), np.zeros((1, 3)), FLAT, (2, 2), 0.1, 1.0, "rigid")
    assert np.allclose(found, 0.4, atol=1e-12)  # no cell meets the spike, whose tip is the place


def test_without_contact_every_cell_reports_max_distance():
    found = distances_at(Surface(boxes(((1, 1, 1), (0, 0, 0)))), [[9.0, 0, 0]], FLAT, (4, 4), 0.1, contact="rigid")
    assert (found == 0.4).all()


def test_depth_is_limited_from_where_it_rests(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 20 * (x * x - y * y))
    found = distances(mesh, [vertex], (16, 16), 0.01, max_distance=0.02, contact="rigid")
    assert found.min() == 0 and found.max() == 0.02


def test_an_unknown_contact_is_named(shapes):
    mesh, vertex = shapes.solid(shapes.sphere)
    with pytest.raises(ValueError, match="tangent, rigid, got 'soft'"):
        distances(mesh, [vertex], contact="soft")
