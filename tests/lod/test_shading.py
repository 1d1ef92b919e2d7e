"""Normals of a written GLB: smooth where the surface is, and divided at creases."""

import json

import numpy as np
import pytest
import trimesh

from haptic_glance.lod.export import write_any
from haptic_glance.lod.topology import shading
from haptic_glance.mesh import load
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import mesh_of


def test_a_ball_is_smooth_and_keeps_its_vertices():
    ball = mesh_of(trimesh.creation.icosphere(3))
    faces, vertices, normals = shading(ball)
    assert np.array_equal(faces, ball.faces) and np.array_equal(vertices, np.arange(len(ball.vertices)))
    assert np.einsum("ij,ij->i", normals, ball.vertices).min() > 0.999


def test_a_box_has_the_normals_of_its_faces():
    box = mesh_of(trimesh.creation.box())
    faces, vertices, normals = shading(box)
    assert len(vertices) == 24 and np.array_equal(vertices[faces], box.faces)
    assert np.allclose(normals[faces], box.face_normals[:, None])
    assert np.array_equal(vertices[:8], np.arange(8))  # further ones come behind those of the mesh


@pytest.mark.parametrize(("sides", "copies"), [(16, 2), (6, 3), (5, 3)])
def test_a_prism_is_round_where_its_sides_meet_at_less_than_sixty_degrees(sides, copies):
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    prism = trimesh.creation.extrude_triangulation(ring, [(0, k, k + 1) for k in range(1, sides - 1)], 1.0)
    _, vertices, normals = shading(mesh_of(prism))
    assert len(vertices) == copies * 2 * sides
    up = np.abs(normals[:, 2])
    assert (up > 1 - 1e-9).sum() == 2 * sides and (up < 1e-9).sum() == (copies - 1) * 2 * sides


@pytest.mark.parametrize(("shape", "corner", "copies"), [("icosphere", 0, 0), ("box", 0, 17), ("box", 1, 16)])
def test_a_face_without_area_makes_no_crease_and_hides_none(shape, corner, copies):
    whole = getattr(trimesh.creation, shape)()
    a, b, c = np.roll(whole.faces[0], -corner)
    vertices = [*whole.vertices, whole.vertices[[a, b]].mean(axis=0)]
    new = len(whole.vertices)
    mesh = Mesh(vertices, [*whole.faces[1:], (a, new, c), (new, b, c), (a, b, new)])  # the last one has no area
    faces, ids, normals = shading(mesh)
    assert len(ids) == len(vertices) + copies
    limit = 0.95 if shape == "icosphere" else 1 - 1e-9
    assert np.einsum("ikj,ij->ik", normals[faces], mesh.face_normals)[:-1].min() > limit


def test_faces_without_area_and_vertices_without_faces_get_a_normal_of_length_one():
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 0, 0], [5, 5, 5]], [[0, 1, 2]])
    assert np.array_equal(shading(mesh)[2], [[0, 0, 1]] * 4)
    assert np.array_equal(shading(Mesh(mesh.vertices, np.zeros((0, 3))))[2], [[0, 0, 1]] * 4)


@pytest.mark.parametrize("named", [None, {"a": np.arange(6), "none": np.arange(0), "b": np.arange(6, 12)}])
def test_a_glb_has_normals_and_is_the_same_mesh_again(tmp_path, named):
    box = Mesh(trimesh.creation.box().vertices, trimesh.creation.box().faces, up="y")
    write_any(tmp_path / "box.glb", box, named)
    content = (tmp_path / "box.glb").read_bytes()
    tree = json.loads(content[20 : 20 + int.from_bytes(content[12:16], "little")])
    primitives = [part["attributes"] for mesh in tree["meshes"] for part in mesh["primitives"]]
    assert len(primitives) == (2 if named else 1) and all("NORMAL" in part for part in primitives)
    again = load(tmp_path / "box.glb")
    assert len(again.vertices) == 8 and np.isclose(again.face_areas.sum(), 6)


def test_a_mesh_without_faces_is_no_glb(tmp_path):
    with pytest.raises(ValueError, match="without faces cannot be written as glb"):
        write_any(tmp_path / "none.glb", Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int)))
