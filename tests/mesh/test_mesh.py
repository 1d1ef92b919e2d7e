"""The mesh's facts on shapes whose answer is known."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh


def as_mesh(shape):
    return Mesh(shape.vertices, shape.faces)


def test_sphere_normals_point_outwards():
    mesh = as_mesh(trimesh.creation.icosphere(3))
    assert (np.einsum("ij,ij->i", mesh.vertex_normals, mesh.vertices) > 0.999).all()


def test_area_of_a_box():
    assert as_mesh(trimesh.creation.box((1, 2, 3))).face_areas.sum() == pytest.approx(22)


def test_open_mesh_is_not_watertight():
    box = as_mesh(trimesh.creation.box())
    assert box.watertight
    assert not Mesh(box.vertices, box.faces[1:]).watertight


def test_a_mesh_is_shown_in_one_line():
    mesh = Mesh(trimesh.creation.icosphere(4).vertices, trimesh.creation.icosphere(4).faces, up="y")
    assert repr(mesh) == "Mesh(2,562 vertices, 5,120 faces, y up)"


def test_rings_grow_one_edge_at_a_time():
    # A strip of triangles: vertex i touches i-2 .. i+2.
    vertices = np.array([(i / 2, i % 2, 0) for i in range(12)], dtype=float)
    strip = Mesh(vertices, np.array([(i, i + 1, i + 2) for i in range(10)]))
    assert np.flatnonzero(strip.rings([0], 0)).tolist() == [0]
    assert np.flatnonzero(strip.rings([0], 1)).tolist() == [0, 1, 2]
    assert np.flatnonzero(strip.rings([0], 2)).tolist() == [0, 1, 2, 3, 4]


def test_vertex_in_no_face_has_a_zero_normal():
    mesh = Mesh(np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (5, 5, 5)], dtype=float), np.array([(0, 1, 2)]))
    np.testing.assert_array_equal(mesh.vertex_normals[3], 0)
    np.testing.assert_allclose(mesh.vertex_normals[:3], [(0, 0, 1)] * 3)


@pytest.mark.parametrize(
    ("vertices", "faces", "reason"),
    [
        (np.zeros((3, 2)), np.zeros((1, 3), int), "vertices must have shape"),
        (np.zeros((3, 3)), np.zeros((1, 4), int), "faces must have shape"),
        (np.zeros((3, 3)), np.full((1, 3), 0.5), "whole numbers"),
        (np.full((3, 3), np.nan), np.zeros((1, 3), int), "NaN"),
        (np.zeros((3, 3)), np.full((1, 3), 3), "outside 0..2"),
        (np.zeros((3, 3)), np.full((1, 3), -1), "outside 0..2"),
    ],
)
def test_bad_arrays_are_refused_at_the_door(vertices, faces, reason):
    with pytest.raises(ValueError, match=reason):
        Mesh(vertices, faces)
