"""Normals are shared over smooth edges and split over sharp ones."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.views.shading import corner_groups
from haptic_glance.mesh.mesh import Mesh


def folded(angle):
    """Two triangles with one edge in common, folded by an angle in degrees."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return Mesh([[0, 0, 0], [0, 1, 0], [-1, 0, 0], [c, 0, -s]], [[0, 1, 2], [1, 0, 3]])


@pytest.mark.parametrize(("angle", "groups"), [(0, 4), (39, 4), (41, 6), (90, 6)])
def test_normals_split_beyond_the_crease(angle, groups):
    assert len(corner_groups(folded(angle))[1]) == groups


@pytest.mark.parametrize("angle", [0, 170])
def test_disagreeing_windings_share_no_normal(angle):
    mesh = folded(angle)
    assert len(corner_groups(Mesh(mesh.vertices, [mesh.faces[0], mesh.faces[1][::-1]]))[1]) == 6


def test_three_faces_at_an_edge_share_no_normal():
    mesh = folded(10)
    fin = Mesh(np.r_[mesh.vertices, [[1.0, 0, 0]]], np.r_[mesh.faces, [[1, 0, 4]]])
    assert len(corner_groups(fin)[1]) == 9


def test_corners_of_a_cube_have_the_normals_of_its_sides():
    box = trimesh.creation.box()
    mesh = Mesh(box.vertices, box.faces)
    groups, normals = corner_groups(mesh)
    assert len(normals) == 24
    assert np.allclose(normals[groups], mesh.face_normals[:, None])


def test_narrow_bevel_leaves_the_wide_face_beside_it_flat():
    wide = folded(30)
    bevel = Mesh(wide.vertices * [[1], [1], [1], [0.02]], wide.faces)
    groups, normals = corner_groups(bevel)
    shared = normals[groups[0, :2]]
    assert np.degrees(np.arccos(shared @ bevel.face_normals[0])).max() < 2


def test_smooth_sphere_has_one_normal_a_vertex_and_it_points_outwards():
    ball = trimesh.creation.icosphere(subdivisions=3)
    groups, normals = corner_groups(Mesh(ball.vertices, ball.faces))
    assert len(normals) == len(ball.vertices)
    assert np.einsum("ijk,ijk->ij", normals[groups], ball.vertices[ball.faces]).min() > 0.999


def test_no_faces_have_no_normals():
    groups, normals = corner_groups(Mesh(np.zeros((3, 3)), np.zeros((0, 3))))
    assert groups.shape == (0, 3) and normals.shape == (0, 3)
