"""The nearest points of a surface, beside those of another program."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.nearest import closest

SHAPES = {
    "ellipsoid": trimesh.creation.icosphere(subdivisions=3).apply_scale([1, 0.7, 0.5]),
    "torus": trimesh.creation.torus(1.0, 0.3),
    "box": trimesh.creation.box((1, 2, 3)).subdivide(),
}


@pytest.mark.parametrize("name", SHAPES)
def test_nearest_points_are_those_of_point_cloud_utils(name):
    other = pytest.importorskip("point_cloud_utils")
    mesh = Mesh(SHAPES[name].vertices, SHAPES[name].faces)
    generator = np.random.default_rng(0)
    faces, weights = generator.integers(len(mesh.faces), size=500), generator.dirichlet([2, 2, 2], 500)
    places = np.einsum("ij,ijk->ik", weights, mesh.vertices[mesh.faces[faces]])
    points = places + 1e-3 * generator.random((500, 1)) * mesh.face_normals[faces]
    distances, found, corners = closest(mesh, points)
    ours = np.einsum("ij,ijk->ik", corners, mesh.vertices[mesh.faces[found]])
    far, face, weights = other.closest_points_on_mesh(points, mesh.vertices, mesh.faces)
    theirs = np.einsum("ij,ijk->ik", weights, mesh.vertices[mesh.faces[face]])
    assert np.abs(ours - theirs).max() < 1e-12 and np.abs(distances - far).max() < 1e-12
    assert np.abs(distances - np.linalg.norm(points - ours, axis=1)).max() < 1e-12
