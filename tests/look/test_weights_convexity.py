"""Convexity: known shapes, and the nearest object."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.weights.convexity import convexity, nearest_convexity
from haptic_glance.mesh.mesh import Mesh

BALL = trimesh.creation.icosphere(3)
CUBE = trimesh.creation.box((1, 1, 1))
TURN = trimesh.transformations.rotation_matrix(0.7, [1, 2, 3])


def kit(mesh):
    return Mesh(np.array(mesh.vertices), np.array(mesh.faces))


def torus(major=1.0, minor=0.4):
    return kit(trimesh.creation.torus(major, minor, major_sections=96, minor_sections=64))


def l_shape():
    corners = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    faces = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)]
    return np.array(corners, dtype=float), np.array(faces)


def bowl(wall=0.0):
    """The lower half of a sphere: one open sheet, or closed with a wall of that thickness."""
    inner = [*arc(1 - wall)[::-1], (0, wall - 1)] if wall else []
    return kit(trimesh.creation.revolve([(0, -1), *arc(1.0), *inner], sections=64))


def arc(radius):
    angles = np.linspace(-np.pi / 2, 0, 33)[1:]
    return [(radius * np.cos(a), radius * np.sin(a)) for a in angles]


@pytest.mark.parametrize("mesh", [BALL, CUBE, trimesh.creation.cylinder(0.3, 2)])
def test_convex_shapes_are_one(mesh):
    assert convexity(kit(mesh)) == pytest.approx(1)


def test_torus_has_its_closed_form():
    R, r = 1.0, 0.4
    hull = 2 * np.pi * R**2 * r + np.pi**2 * r**2 * R + 4 / 3 * np.pi * r**3  # a disc and the outer half of the tube
    assert convexity(torus()) == pytest.approx(2 * np.pi**2 * R * r**2 / hull, rel=2e-3)


def test_prism_over_an_l_is_three_in_three_and_a_half():
    corners, faces = l_shape()
    prism = trimesh.creation.extrude_triangulation(corners, faces, 1.0)
    assert convexity(kit(prism)) == pytest.approx(3 / 3.5)


def test_flat_mesh_compares_areas():
    corners, faces = l_shape()
    flat = np.column_stack([corners, np.zeros(6)]) @ TURN[:3, :3].T
    assert convexity(Mesh(flat, faces)) == pytest.approx(3 / 3.5)
    assert convexity(Mesh(flat, np.concatenate([faces, faces[:, ::-1]]))) == pytest.approx(3 / 3.5)


def test_one_triangle_is_one():
    assert convexity(Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])) == pytest.approx(1)


@pytest.mark.parametrize("thickness", [1e-6, 1e-4])
def test_thin_shapes_still_compare_volumes(thickness):
    corners, faces = l_shape()
    assert convexity(kit(trimesh.creation.extrude_triangulation(corners, faces, thickness))) == pytest.approx(3 / 3.5)


def test_an_open_sheet_counts_as_full_and_a_wall_as_wall():
    assert not bowl().watertight and bowl(wall=0.1).watertight
    assert convexity(bowl()) == pytest.approx(1)
    assert convexity(bowl(wall=0.1)) == pytest.approx(1 - 0.9**3, abs=0.01)


def test_a_crack_changes_next_to_nothing():
    mesh = torus()
    assert convexity(Mesh(mesh.vertices, mesh.faces[1:])) == pytest.approx(convexity(mesh), rel=1e-3)


def test_two_holes_get_a_lid_each():
    tube = trimesh.creation.cylinder(0.5, 2.0, sections=64)
    sides = np.abs(tube.face_normals[:, 2]) < 0.5
    assert convexity(Mesh(tube.vertices, tube.faces[sides])) == pytest.approx(1)


@pytest.mark.slow
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_size_place_and_turn_do_not_matter(scale):
    mesh = torus()
    moved = trimesh.transform_points(mesh.vertices, TURN) * scale + 7 * scale
    assert convexity(Mesh(moved, mesh.faces)) == pytest.approx(convexity(mesh), rel=1e-9)


def test_inward_normals_do_not_matter():
    mesh = torus()
    assert convexity(Mesh(mesh.vertices, mesh.faces[:, ::-1])) == pytest.approx(convexity(mesh))


@pytest.mark.slow
def test_vertex_order_loose_vertices_and_unmerged_corners_do_not_matter():
    mesh = torus()
    order = np.random.default_rng(0).permutation(len(mesh.vertices))
    shuffled = Mesh(np.concatenate([mesh.vertices[order], [[9, 9, 9]]]), np.argsort(order)[mesh.faces])
    soup = Mesh(mesh.vertices[mesh.faces].reshape(-1, 3), np.arange(mesh.faces.size).reshape(-1, 3))
    assert convexity(shuffled) == pytest.approx(convexity(mesh))
    assert convexity(soup) == pytest.approx(convexity(mesh))


def test_pieces_far_apart_add_up():
    away = trimesh.creation.box((1, 1, 1), transform=trimesh.transformations.translation_matrix([9, 0, 0]))
    assert convexity(kit(CUBE + away)) == pytest.approx(2 / 10)


def test_pieces_on_top_of_each_other_stay_at_one():
    assert convexity(kit(CUBE + CUBE)) == 1


@pytest.mark.parametrize("faces", [np.zeros((0, 3), dtype=int), [[0, 1, 1]], [[0, 1, 2]]])
def test_a_mesh_without_area_is_an_error(faces):
    with pytest.raises(ValueError, match="no face with an area"):
        convexity(Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], faces))


def test_the_nearest_in_convexity_is_found():
    assert nearest_convexity(0.6, {"mug": 0.28, "elephant": 0.66, "cube": 1.0}) == "elephant"


def test_of_equally_near_ones_the_first_by_name_whatever_the_rounding():
    assert nearest_convexity(1.0, {"sphere": 1.0, "cube": 1 - 1e-12}) == "cube"
    assert nearest_convexity(0.5, {"b": 0.6, "a": 0.4}) == nearest_convexity(0.5, {"a": 0.4, "b": 0.6}) == "a"


@pytest.mark.parametrize(("value", "others"), [(0.5, {}), (float("nan"), {"a": 0.5}), (0.5, {"a": float("inf")})])
def test_nothing_to_choose_from_is_an_error(value, others):
    with pytest.raises(ValueError, match="no other object to choose|must be finite"):
        nearest_convexity(value, others)
