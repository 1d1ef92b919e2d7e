"""The raw distances of the virtual pressure array against known shapes, and against rays cast one by one."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from haptic_glance import press, press_many, repair
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene
from haptic_glance.touch import Surface, distances, distances_at, sensor_axes, sensor_normals, touchable
from haptic_glance.touch.surface import LIFT
from tests.shapes import flat_grid

SURFACES = {
    "sphere": lambda x, y: np.sqrt(0.3**2 - x**2 - y**2),
    "saddle": lambda x, y: 2 * x * x - 3 * y * y,
    "step": lambda x, y: np.where(np.abs(x) > 0.031, 0.2, 0.0),
    "pyramid": lambda x, y: -np.maximum(np.abs(x), np.abs(y)),
}
ROTATION = Rotation.from_euler("xyz", [0.4, -1.1, 2.0]).as_matrix()


@pytest.mark.parametrize("cells", [(15, 15), (8, 20)])
@pytest.mark.parametrize("name", SURFACES)
def test_distances_are_exact_and_negative_inside(shapes, name, cells):
    mesh, vertex = shapes.solid(SURFACES[name])
    x, y = shapes.cell_places(cells, 0.01)
    expected = SURFACES[name](0.0, 0.0) - SURFACES[name](x, y)
    assert np.allclose(distances(mesh, [vertex], cells, 0.01, max_distance=1.0)[0], expected, atol=1e-14, rtol=0)
    assert distances(mesh, np.zeros(0, dtype=int), cells).shape == (0, *cells)


def test_cells_off_the_object_report_max_distance(shapes):
    mesh, vertex = shapes.solid(shapes.sphere, half=12)
    lengths = distances(mesh, [vertex], (16, 16), 0.01)[0]
    x, y = shapes.cell_places((16, 16), 0.01)
    off = np.maximum(abs(x), abs(y)) > 0.06
    assert (lengths[off] == 0.16).all() and (lengths[~off] < 0.16).all()


def test_max_distance_bounds_the_distance_both_ways(shapes):
    mesh, vertex = shapes.solid(lambda x, y: 20 * (x * x - y * y))
    lengths = distances(mesh, [vertex], (16, 16), 0.01, max_distance=0.02)
    assert lengths.min() == -0.02 and lengths.max() == 0.02


def test_turning_and_scaling_mesh_and_array_together_changes_nothing(shapes):
    mesh, vertex = shapes.solid(SURFACES["saddle"])
    axes = sensor_axes(sensor_normals(mesh, [vertex]))
    moved = distances(shapes.turned(mesh, ROTATION, 10.0, scale=0.01), [vertex], pitch=1e-4, axes=axes @ ROTATION.T)
    assert np.allclose(100 * moved, distances(mesh, [vertex], pitch=0.01), atol=1e-9)


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


@pytest.mark.parametrize(
    "change, words",
    [
        ({"cells": (0, 16)}, "cells must be"),
        ({"cells": (16,)}, "cells must be"),
        ({"cells": (2.5, 4)}, "cells must be"),
        ({"cells": (np.nan, 4)}, "cells must be"),
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
        ({"contact": "soft"}, "tangent, rigid, got 'soft'"),
    ],
)
def test_what_makes_no_touch_is_named(change, words):
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [5, 5, 5], [1, 1, 0], [2, 1, 0]]
    faces = [[0, 1, 2], [0, 2, 3], [5, 6, 1], [5, 1, 6]]  # vertex 4 is in no face, the faces of vertex 5 cancel out
    with pytest.raises(ValueError, match=words):
        distances(Mesh(corners, faces), **{"vertices": [0], **change})


def by_rays(mesh, centres, axes, cells, pitch):
    """(k, rows, cols) signed distances, inf where missed, one ray a cell down, and one up where it may be inside."""
    rows, columns = cells
    middle = (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
    scene, lift = RayScene(Mesh(mesh.vertices - middle, mesh.faces)), LIFT * mesh.diagonal
    right, up, normal = axes.transpose(1, 0, 2)[:, :, None, None]
    down_rows = (((rows - 1) / 2 - np.arange(rows)) * pitch)[:, None, None]
    along_columns = ((np.arange(columns) - (columns - 1) / 2) * pitch)[None, :, None]
    points = ((centres - middle)[:, None, None] + down_rows * up + along_columns * right).reshape(-1, 3)
    normals = np.broadcast_to(normal, (len(centres), rows, columns, 3)).reshape(-1, 3)

    def cast(origins, directions):
        hits = scene.cast(origins, directions)
        return hits.distance, hits.hit & (np.einsum("ij,ij->i", scene.mesh.face_crosses[hits.face], directions) > 0)

    below, from_back = cast(points + lift * normals, -normals)
    lengths, maybe = below - lift, np.flatnonzero(from_back)
    above, out_of_object = cast(points[maybe] - lift * normals[maybe], normals[maybe])
    lengths[maybe[out_of_object]] = lift - above[out_of_object]
    return lengths.reshape(len(centres), rows, columns)


def shaped(name):
    """A mesh of trimesh, turned so that no face lies along a column by chance."""
    made = {
        "ball": lambda: trimesh.creation.icosphere(subdivisions=4, radius=0.5),
        "ring": lambda: trimesh.creation.torus(0.35, 0.12, major_sections=90, minor_sections=40),
        "box": lambda: trimesh.creation.box((0.8, 0.5, 0.3)),
        "pipe": lambda: trimesh.creation.annulus(0.2, 0.3, 0.7),
    }[name]()
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    return Mesh(made.vertices @ (turn * np.linalg.det(turn)), made.faces)


def compare(mesh, cells, pitch, count=20):
    """The share of cells in which both ways differ, at vertices drawn at random."""
    random = np.random.default_rng(0)
    vertices = random.permutation(len(mesh.vertices))
    vertices = vertices[touchable(mesh, vertices)][:count]
    axes, max_distance = sensor_axes(sensor_normals(mesh, vertices)), 2 * mesh.diagonal
    expected = np.clip(by_rays(mesh, mesh.vertices[vertices], axes, cells, pitch), -max_distance, max_distance)
    lengths = distances_at(Surface(mesh), mesh.vertices[vertices], axes, cells, pitch, max_distance)
    return float((np.abs(lengths - expected) > 1e-9).mean())


@pytest.mark.parametrize(
    ("name", "cells", "pitch"),
    [("ball", (9, 16), 0.1), ("ring", (32, 32), 0.01), ("box", (16, 12), 0.002), ("pipe", (32, 32), 0.01)],
)
def test_cells_feel_what_rays_meet(name, cells, pitch):
    assert compare(shaped(name), cells, pitch) < 2e-4  # embree, in single precision, misses a hit on an edge


def test_cells_feel_what_rays_meet_among_triangles_turned_anyhow():
    random = np.random.default_rng(4)
    corners = random.uniform(-0.4, 0.4, (300, 1, 3)) + random.normal(0, 0.1, (300, 3, 3))
    assert compare(Mesh(corners.reshape(-1, 3), np.arange(900).reshape(-1, 3)), (24, 24), 0.03) < 2e-4


def test_no_column_slips_between_faces():
    mesh = shaped("ball")
    places = mesh.vertices[mesh.faces]
    ends = np.concatenate([places[:, 0], (places[:, 0] + places[:, 1]) / 2, places[:, 0] * 0.3 + places[:, 2] * 0.7])
    axes = sensor_axes(ends / np.linalg.norm(ends, axis=1)[:, None])
    lifted = ends + 0.05 * axes[:, 2]  # one cell each, right above a vertex or a place on an edge
    assert np.allclose(distances_at(Surface(mesh), lifted, axes, (1, 1), 0.1), 0.05, atol=1e-12)


def test_the_order_of_the_faces_changes_no_bit():
    mesh = shaped("ring")
    shuffled = Mesh(mesh.vertices, np.random.default_rng(2).permutation(mesh.faces))
    axes = sensor_axes(sensor_normals(mesh, [5, 90]))
    centres = mesh.vertices[[5, 90]]
    first, other = (distances_at(Surface(variant), centres, axes, (32, 32), 0.02) for variant in (mesh, shuffled))
    assert np.array_equal(first, other)


def test_where_one_part_stands_on_another_its_inside_is_inside_whatever_the_order_of_faces():
    low, high = (trimesh.creation.box((1, 1, 1), trimesh.transformations.translation_matrix((0, 0, z))) for z in (0, 1))
    tower = trimesh.util.concatenate([low, high])
    for faces in (tower.faces, tower.faces[::-1]):
        lengths = distances_at(
            Mesh(tower.vertices, faces), [[0.1, 0.2, 0.9]], np.eye(3)[None], (4, 4), 0.1, max_distance=5.0
        )
        assert np.allclose(lengths, -0.6, atol=1e-15)


def test_a_part_that_is_inside_out_beside_a_larger_one_is_warned_of_where_it_is_touched(recwarn):
    ball = trimesh.creation.icosphere(2, radius=0.5)
    count = len(ball.vertices)
    vertices = np.vstack([ball.vertices, 0.4 * ball.vertices + 2])
    mesh = Mesh(vertices, np.vstack([ball.faces, ball.faces[:, ::-1] + count]))
    assert press(mesh, 0).max() == 1 and not recwarn.list
    with pytest.warns(UserWarning, match=rf"nothing at vertex {count + 3} and 1 others: the faces there look inwards"):
        press_many(mesh, [0, count + 3, count + 5])
    assert press_many(repair(mesh), [0, count + 3]).max(axis=(1, 2)).tolist() == [1, 1]


def test_a_closed_mesh_that_is_inside_out_is_warned_of_and_its_repair_is_not(recwarn):
    ball = trimesh.creation.icosphere(2, radius=0.5)
    inside_out = Mesh(ball.vertices, ball.faces[:, ::-1])
    for faces in (ball.faces, ball.faces[1:, ::-1]):  # an open mesh has no inside
        Surface(Mesh(ball.vertices, faces))
    assert not recwarn.list
    with pytest.warns(UserWarning, match=r"look inwards.*`haptic_glance.repair`"):
        Surface(inside_out)
    assert press(repair(inside_out), 0).max() == 1
    assert not recwarn.list


def bowl():
    """(Mesh of a bowl z = x² + y² that is seen from inside and open everywhere else, its lowest vertex)."""
    grid = flat_grid(61, 61)
    x, y = (grid.vertices[:, :2].T - 30) / 60
    return Mesh(np.column_stack([x, y, x**2 + y**2]), grid.faces), 30 * 61 + 30


def test_the_walls_of_a_bowl_that_a_camera_saw_are_felt_although_nothing_is_below_them():
    mesh, lowest = bowl()
    steps = 0.03 * np.arange(-2, 3)
    assert Surface(mesh).is_sheet
    felt = distances(mesh, [lowest], (5, 5), 0.03)[0]
    assert felt == pytest.approx(-(steps**2 + steps[:, None] ** 2), abs=3e-4)


def test_holes_make_no_sheet():
    ball = trimesh.creation.icosphere(subdivisions=3)
    assert not Surface(Mesh(ball.vertices, ball.faces)).is_sheet
    assert not Surface(Mesh(ball.vertices, ball.faces[64:])).is_sheet  # a twentieth of the faces, here and there
    assert Surface(Mesh(ball.vertices, ball.faces[ball.triangles_center[:, 2] > 0])).is_sheet
