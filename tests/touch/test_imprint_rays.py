"""The array's distances against rays cast one by one: embree, as `distances` defines what each cell feels."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from haptic_glance.base.files import read_mesh
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene
from haptic_glance.touch import Surface, distances, distances_at, sensor_axes, sensor_normals, touchable
from haptic_glance.touch.surface import LIFT

MESHES = Path(__file__).parents[2] / "data/meshes"


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
    found, maybe = below - lift, np.flatnonzero(from_back)
    above, out_of_object = cast(points[maybe] - lift * normals[maybe], normals[maybe])
    found[maybe[out_of_object]] = lift - above[out_of_object]
    return found.reshape(len(centres), rows, columns)


def soup(count=300):
    """Triangles anywhere, turned anyhow, cutting each other."""
    random = np.random.default_rng(4)
    corners = random.uniform(-0.4, 0.4, (count, 1, 3)) + random.normal(0, 0.1, (count, 3, 3))
    return Mesh(corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))


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
    found = distances_at(Surface(mesh), mesh.vertices[vertices], axes, cells, pitch, max_distance)
    return float((np.abs(found - expected) > 1e-9).mean())


@pytest.mark.parametrize("cells, pitch", [((32, 32), 0.01), ((16, 12), 0.002), ((9, 16), 0.1)])
@pytest.mark.parametrize("name", ["ball", "ring", "box", "pipe"])
def test_cells_feel_what_rays_meet(name, cells, pitch):
    assert compare(shaped(name), cells, pitch) < 2e-4  # embree, in single precision, misses a hit on an edge


def test_cells_feel_what_rays_meet_among_triangles_turned_anyhow():
    assert compare(soup(), (24, 24), 0.03) < 2e-4


@pytest.mark.parametrize("name", ["elephant", "eyeglasses", "hand", "cup", "stanfordbunny"])
def test_cells_feel_what_rays_meet_on_household_objects(name):
    if not (MESHES / f"{name}.npz").exists():
        pytest.skip("data/meshes is not there: dvc repro meshes")
    assert compare(read_mesh(MESHES / f"{name}.npz"), (32, 32), 0.01) < 2e-4


def test_no_column_slips_between_faces():
    mesh = shaped("ball")
    places = mesh.vertices[mesh.faces]
    ends = np.concatenate([places[:, 0], (places[:, 0] + places[:, 1]) / 2, places[:, 0] * 0.3 + places[:, 2] * 0.7])
    axes = sensor_axes(ends / np.linalg.norm(ends, axis=1)[:, None])
    lifted = ends + 0.05 * axes[:, 2]  # one cell each, right above a vertex or a place on an edge
    assert np.allclose(distances_at(Surface(mesh), lifted, axes, (1, 1), 0.1), 0.05, atol=1e-12)


def test_a_surface_of_many_blocks_gives_what_the_mesh_gives():
    mesh = shaped("ring")
    vertices = [3, 700, 1500]
    assert np.array_equal(distances(Surface(mesh), vertices), distances(mesh, vertices))


def test_an_array_is_measured_alike_alone_and_among_others():
    mesh = shaped("ring")
    vertices = np.arange(0, 2000, 40)
    many = distances(mesh, vertices, (32, 32), 0.008)
    assert all(
        np.array_equal(distances(mesh, [v], (32, 32), 0.008)[0], one) for v, one in zip(vertices, many, strict=True)
    )


def test_the_order_of_the_faces_changes_no_bit():
    mesh = shaped("ring")
    shuffled = Mesh(mesh.vertices, np.random.default_rng(2).permutation(mesh.faces))
    axes = sensor_axes(sensor_normals(mesh, [5, 90]))
    centres = mesh.vertices[[5, 90]]
    one, other = (distances_at(Surface(each), centres, axes, (32, 32), 0.02) for each in (mesh, shuffled))
    assert np.array_equal(one, other)


def test_where_one_part_stands_on_another_its_inside_is_inside_whatever_the_order_of_faces():
    low, high = (trimesh.creation.box((1, 1, 1), trimesh.transformations.translation_matrix((0, 0, z))) for z in (0, 1))
    both = trimesh.util.concatenate([low, high])
    for faces in (both.faces, both.faces[::-1]):
        found = distances_at(
            Mesh(both.vertices, faces), [[0.1, 0.2, 0.9]], np.eye(3)[None], (4, 4), 0.1, max_distance=5.0
        )
        assert np.allclose(found, -0.6, atol=1e-15)
