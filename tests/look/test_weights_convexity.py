"""Convexity: known shapes, and the nearest object."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.weights.convexity import convexity, nearest_convexity
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import mesh_of

CUBE = trimesh.creation.box((1, 1, 1))
TUBE = trimesh.creation.cylinder(0.5, 2.0, sections=64)
TORUS = mesh_of(trimesh.creation.torus(1.0, 0.4, major_sections=96, minor_sections=64))
TURN = trimesh.transformations.rotation_matrix(0.7, [1, 2, 3])
L_CORNERS = np.array([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], dtype=float)
L_FACES = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)])
FLAT = np.column_stack([L_CORNERS, np.zeros(6)]) @ TURN[:3, :3].T


def prism(thickness):
    return mesh_of(trimesh.creation.extrude_triangulation(L_CORNERS, L_FACES, thickness))


def bowl(wall=0.0):
    """The lower half of a sphere: one open sheet, or closed with a wall of that thickness."""
    inner = [*arc(1 - wall)[::-1], (0, wall - 1)] if wall else []
    return mesh_of(trimesh.creation.revolve([(0, -1), *arc(1.0), *inner], sections=64))


def arc(radius):
    angles = np.linspace(-np.pi / 2, 0, 33)[1:]
    return [(radius * np.cos(a), radius * np.sin(a)) for a in angles]


@pytest.mark.parametrize(
    ("mesh", "value"),
    [
        (mesh_of(trimesh.creation.icosphere(3)), 1),
        (mesh_of(CUBE), 1),
        (Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), 1),
        (prism(1.0), 3 / 3.5),
        (prism(1e-6), 3 / 3.5),  # a thin shape still compares volumes
        (Mesh(FLAT, L_FACES), 3 / 3.5),  # a flat one compares areas
        (Mesh(FLAT, np.concatenate([L_FACES, L_FACES[:, ::-1]])), 3 / 3.5),
        (bowl(), 1),  # an open sheet counts as full
        (Mesh(TUBE.vertices, TUBE.faces[np.abs(TUBE.face_normals[:, 2]) < 0.5]), 1),  # two holes get a lid each
        (mesh_of(CUBE + CUBE), 1),
        (mesh_of(CUBE + CUBE.copy().apply_translation([9, 0, 0])), 2 / 10),
    ],
)
def test_convexity_of_shapes_by_hand(mesh, value):
    assert convexity(mesh) == pytest.approx(value)


def test_torus_has_its_closed_form_and_a_bowl_with_a_wall_counts_as_wall():
    R, r = 1.0, 0.4
    hull = 2 * np.pi * R**2 * r + np.pi**2 * r**2 * R + 4 / 3 * np.pi * r**3  # a disc and the outer half of the tube
    assert convexity(TORUS) == pytest.approx(2 * np.pi**2 * R * r**2 / hull, rel=2e-3)
    assert convexity(bowl(wall=0.1)) == pytest.approx(1 - 0.9**3, abs=0.01)


@pytest.mark.slow
def test_a_crack_size_place_turn_order_winding_loose_vertices_and_seams_hardly_matter():
    expected = convexity(TORUS)
    assert convexity(Mesh(TORUS.vertices, TORUS.faces[1:])) == pytest.approx(expected, rel=1e-3)
    for scale in (1e-3, 1e4):
        moved = trimesh.transform_points(TORUS.vertices, TURN) * scale + 7 * scale
        assert convexity(Mesh(moved, TORUS.faces[:, ::-1])) == pytest.approx(expected, rel=1e-9)
    order = np.random.default_rng(0).permutation(len(TORUS.vertices))
    shuffled = Mesh(np.concatenate([TORUS.vertices[order], [[9, 9, 9]]]), np.argsort(order)[TORUS.faces])
    soup = Mesh(TORUS.vertices[TORUS.faces].reshape(-1, 3), np.arange(TORUS.faces.size).reshape(-1, 3))
    assert convexity(shuffled) == pytest.approx(expected) == convexity(soup)


@pytest.mark.parametrize("faces", [np.zeros((0, 3), dtype=int), [[0, 1, 1]], [[0, 1, 2]]])
def test_a_mesh_without_area_is_an_error(faces):
    with pytest.raises(ValueError, match="no face with an area"):
        convexity(Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], faces))


def test_the_nearest_in_convexity_is_found_and_of_equally_near_ones_the_first_by_name_whatever_the_rounding():
    assert nearest_convexity(0.6, {"mug": 0.28, "elephant": 0.66, "cube": 1.0}) == "elephant"
    assert nearest_convexity(1.0, {"sphere": 1.0, "cube": 1 - 1e-12}) == "cube"
    assert nearest_convexity(0.5, {"b": 0.6, "a": 0.4}) == nearest_convexity(0.5, {"a": 0.4, "b": 0.6}) == "a"
