"""The mesh's facts, and the points sampled on it, on shapes whose answer is known."""

import numpy as np
import pytest
import trimesh
from PIL import Image

from haptic_glance.mesh.materials import texture_of
from haptic_glance.mesh.mesh import Mesh, Texture
from haptic_glance.mesh.sampling import points_in_faces, sample_surface
from tests.shapes import mesh_of


def test_normals_areas_and_holes_of_known_shapes():
    ball, box = mesh_of(trimesh.creation.icosphere(3)), mesh_of(trimesh.creation.box((1, 2, 3)))
    assert (np.einsum("ij,ij->i", ball.vertex_normals, ball.vertices) > 0.999).all()
    assert box.face_areas.sum() == pytest.approx(22)
    assert box.watertight and not Mesh(box.vertices, box.faces[1:]).watertight
    assert repr(Mesh(ball.vertices, ball.faces, up="y")) == "Mesh(642 vertices, 1,280 faces, y up)"


def test_rings_grow_one_edge_at_a_time():
    # A strip of triangles: vertex i touches i-2 .. i+2.
    vertices = np.array([(i / 2, i % 2, 0) for i in range(12)], dtype=float)
    strip = Mesh(vertices, np.array([(i, i + 1, i + 2) for i in range(10)]))
    assert np.flatnonzero(strip.rings([0], 0)).tolist() == [0]
    assert np.flatnonzero(strip.rings([0], 1)).tolist() == [0, 1, 2]
    assert np.flatnonzero(strip.rings([0], 2)).tolist() == [0, 1, 2, 3, 4]


def test_vertex_whose_faces_cancel_out_has_a_zero_normal_whatever_the_rounding():
    corners = np.array([(0.1, 0.7, 0.3), (1.3, 0.2, 0.9), (0.6, 1.1, -0.4), (0.2, 0.3, 1.7)])
    mesh = Mesh(corners, np.array([(0, 1, 2), (2, 1, 0), (1, 3, 2)]))
    np.testing.assert_array_equal(mesh.vertex_normals[0], 0)
    np.testing.assert_allclose(mesh.vertex_normals[[1, 2, 3]], mesh.face_normals[[2, 2, 2]], atol=1e-9)


def test_vertex_in_no_face_has_a_zero_normal():
    mesh = Mesh(np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (5, 5, 5)], dtype=float), np.array([(0, 1, 2)]))
    np.testing.assert_array_equal(mesh.vertex_normals[3], 0)
    np.testing.assert_allclose(mesh.vertex_normals[:3], [(0, 0, 1)] * 3)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Mesh(np.zeros((3, 2)), np.zeros((1, 3), int)), "vertices must have shape"),
        (lambda: Mesh(np.zeros((3, 3)), np.zeros((1, 4), int)), "faces must have shape"),
        (lambda: Mesh(np.zeros((3, 3)), np.full((1, 3), 0.5)), "whole numbers"),
        (lambda: Mesh(np.full((3, 3), np.nan), np.zeros((1, 3), int)), "NaN"),
        (lambda: Mesh(np.zeros((3, 3)), np.full((1, 3), 3)), "outside 0..2"),
        (lambda: Mesh(np.zeros((3, 3)), np.full((1, 3), -1)), "outside 0..2"),
        (lambda: sample_surface(Mesh(CORNERS, [[0, 0, 1]]), np.array([0.5]), np.full((2, 1), 0.5)), "without area"),
        (lambda: sample_surface(Mesh(CORNERS, np.zeros((0, 3))), np.array([0.5]), np.full((2, 1), 0.5)), "area"),
        (lambda: Mesh(np.eye(3), [[0, 1, 2]], np.full((3, 3), 300)), r"colors must lie in 0\.\.255"),
        (lambda: Mesh(np.eye(3), [[0, 1, 2]], np.full((3, 3), -1)), r"colors must lie in 0\.\.255"),
        (lambda: paint(colour=300), "must be whole numbers"),
        (lambda: Texture(np.zeros((1, 3, 2)), [0], ([[[300, 0, 0, 0]]],)), "must be whole numbers"),
        (lambda: paint(colour=0.5), "must be whole numbers"),
        (lambda: paint(image=0.5), "must be whole numbers"),
    ],
)
def test_wrong_arguments_are_named_with_what_is_right(call, words):
    with pytest.raises(ValueError, match=words):
        call()


def test_the_arrays_of_a_mesh_are_its_own_and_of_the_one_type_that_kernels_are_compiled_for():
    base = np.eye(3)
    view = base.view()
    view.flags.writeable = False
    stored = np.frombuffer(base.tobytes()).reshape(3, 3)
    for storage in (base, view, stored):
        mesh = Mesh(storage, [[0, 1, 2]])
        assert mesh.vertices.flags.writeable and not np.shares_memory(mesh.vertices, storage)
    picture = paint().images[0]
    assert Texture(np.zeros((1, 3, 2)), [0], (picture,)).images[0] is picture  # it can be large, and is never changed


CORNERS = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 1], [5, 5, 5]], dtype=float)
THREE = Mesh(CORNERS, [[0, 1, 2], [0, 2, 3], [0, 3, 1]])  # areas 2, 1, 1


def sampled(count, areas=None):
    random = np.random.default_rng(0)
    return sample_surface(THREE, (np.arange(count) + random.random(count)) / count, random.random((2, count)), areas)


def test_each_face_gets_its_share_of_the_points_to_within_one():
    _, faces, _ = sampled(1001)
    assert np.abs(np.bincount(faces) - 1001 * np.array([0.5, 0.25, 0.25])).max() < 1
    _, faces, _ = sampled(1000, areas=np.array([0.0, 3.0, 1.0]))
    assert np.bincount(faces).tolist() == [0, 750, 250]
    _, faces, _ = sample_surface(THREE, np.array([0.0, 1.0]), np.full((2, 2), 0.5))
    assert faces.tolist() == [0, 2]


def test_points_are_the_weighted_corners_of_their_faces():
    points, faces, weights = sampled(500)
    assert (weights >= 0).all() and weights.sum(axis=1) == pytest.approx(1)
    assert points == pytest.approx(np.einsum("ki,kij->kj", weights, CORNERS[THREE.faces[faces]]))


def test_points_are_uniform_within_a_face():
    draws = np.stack([grid.ravel() for grid in np.meshgrid(*2 * [(np.arange(200) + 0.5) / 200], indexing="ij")])
    points, _ = points_in_faces(THREE, np.zeros(len(draws[0]), dtype=np.int64), draws)
    assert points.mean(axis=0) == pytest.approx([2 / 3, 2 / 3, 0], abs=1e-4)  # the centroid
    assert (points[:, :2].sum(axis=1) < 1).mean() == pytest.approx(0.25, abs=0.01)  # a quarter of the area


def test_memory_that_a_caller_lends_is_copied():
    lent = np.eye(3)
    mesh = Mesh(memoryview(lent), [[0, 1, 2]])
    lent[0, 0] = 7
    assert mesh.vertices[0, 0] == 1


def paint(uv=0.0, image=0, colour=255):
    return Texture(np.full((1, 3, 2), uv), [image], (np.full((2, 2, 4), colour),))


def test_a_texture_keeps_its_paint_when_the_caller_s_arrays_change():
    uv, pixels = np.zeros((1, 3, 2)), np.zeros((1, 1, 4), dtype=np.uint8)
    texture = Texture(uv, [0], (pixels,))
    uv += 1
    pixels += 1
    assert not texture.uv.any() and not texture.images[0].any()


def test_coordinates_too_large_for_a_file_are_refused_and_those_of_a_file_become_zero():
    with pytest.raises(ValueError, match="uv must be finite, and at most"):
        paint(uv=1e308)
    picture = trimesh.visual.material.SimpleMaterial(image=Image.new("RGB", (2, 2), "red"))
    visual = trimesh.visual.TextureVisuals([(1e308, 0.5), (0.5, np.inf), (np.nan, 1e30)], material=picture)
    read = texture_of([trimesh.Trimesh(np.eye(3), [[0, 1, 2]], visual=visual, process=False)])
    assert read.uv[0].tolist() == [[0, 0.5], [0.5, 0], [0, 1e30]]
