"""The nearest point of a surface: against a library, on awkward meshes, near and far."""

import numpy as np
import point_cloud_utils
import pytest
import trimesh

from haptic_glance.lod.errors import SurfaceIndex, metro, vertex_errors
from haptic_glance.mesh.mesh import Mesh

BALL = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
SPHERE = Mesh(BALL.vertices, BALL.faces)


def waves(side):
    """A wavy sheet of 2 side * side faces whose cells are long and thin."""
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, side + 1), np.linspace(-0.05, 0.05, side + 1), indexing="ij")
    vertices = np.stack([x, y, 0.1 * np.sin(9 * x)], axis=-1).reshape(-1, 3)
    corner = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
    faces = [[corner, corner + 1, corner + side + 2], [corner, corner + side + 2, corner + side + 1]]
    return Mesh(vertices, np.concatenate([np.stack(each, axis=1) for each in faces]))


def soup(seed=0):
    """Triangles of all sizes thrown about, some of them needles, two far apart from the rest."""
    generator = np.random.default_rng(seed)
    corners = generator.normal(size=(300, 1, 3)) + generator.exponential(0.2, (300, 1, 1)) * generator.normal(
        size=(300, 3, 3)
    )
    corners[:20, 2] = corners[:20, 1] + 1e-9 * corners[:20, 0]
    corners[-2:] += 50
    return Mesh(corners.reshape(-1, 3), np.arange(900).reshape(-1, 3))


MESHES = {"sphere": SPHERE, "waves": waves(24), "soup": soup(), "one triangle": Mesh(np.eye(3), [[0, 1, 2]])}


@pytest.mark.slow
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("spread", [1.0, 1.05, 0.0, 3.0, 100.0])
def test_distances_agree_with_point_cloud_utils(name, spread):
    mesh = MESHES[name]
    noise = np.random.default_rng(1).normal(size=(400, 3))
    points = spread * mesh.vertices[np.arange(400) % len(mesh.vertices)] + 0.02 * noise
    expected, _, _ = point_cloud_utils.closest_points_on_mesh(points, mesh.vertices, mesh.faces)
    found, faces = SurfaceIndex(mesh).nearest(points)
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-12)
    alone = [
        SurfaceIndex(Mesh(mesh.vertices, mesh.faces[[face]])).nearest(points[[k]])[0][0] for k, face in enumerate(faces)
    ]
    assert np.array(alone) == pytest.approx(found, rel=1e-9, abs=1e-12)


def test_order_of_the_questions_does_not_matter():
    surface, points = SurfaceIndex(SPHERE), np.random.default_rng(2).normal(scale=0.3, size=(500, 3))
    order = np.random.default_rng(3).permutation(500)
    assert surface.nearest(points[order])[0] == pytest.approx(surface.nearest(points)[0][order], rel=1e-12)


def test_weights_name_the_nearest_place():
    points = np.random.default_rng(4).normal(scale=0.5, size=(300, 3))
    for mesh in MESHES.values():
        surface = SurfaceIndex(mesh)
        found, faces = surface.nearest(points)
        weights = surface.weights(points, faces)
        assert weights.min() >= 0 and weights.sum(axis=1) == pytest.approx(np.ones(300))
        place = np.einsum("ij,ijk->ik", weights, mesh.vertices[mesh.faces[faces]])
        assert np.linalg.norm(points - place, axis=1) == pytest.approx(found, rel=1e-6, abs=1e-9)


def test_faces_without_area_are_segments_and_points():
    mesh = Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 5, 5]], [[0, 1, 2], [2, 0, 1], [3, 3, 3], [0, 2, 2]])
    points = np.array([[0.5, 1, 0], [3, 0, 0], [-1, 0, 0], [5, 5, 6], [1, 0, 0]])
    assert SurfaceIndex(mesh).nearest(points)[0] == pytest.approx([1, 1, 1, 1, 0])


@pytest.mark.parametrize("height", [1e-2, 1e-5, 1e-8, 1e-11, 1e-13, 1e-15, 0.0])
@pytest.mark.parametrize("foot", [0.3, 0.0, 1.0, 1.5, -0.5])
def test_needles_are_as_far_as_their_sides_at_most_their_height_less(height, foot):
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    corners = np.array([[0, 0, 0], [1, 0, 0], [foot, height, 0]]) @ turn + 0.1
    along, up = np.meshgrid([-2, -1e-3, 0, 0.2, 0.5, 0.999, 1, 1 + 1e-6, 2], [0, 1e-9, 1e-3, 1])
    places = np.stack([along.ravel(), np.zeros(36), up.ravel()], axis=1)
    low, high = min(foot, 0), max(foot, 1)
    expected = np.hypot(places[:, 0] - places[:, 0].clip(low, high), places[:, 2])
    found, _ = SurfaceIndex(Mesh(corners, [[0, 1, 2]])).nearest(places @ turn + 0.1)
    assert np.abs(found - expected).max() <= height + 1e-12


def test_near_questions_are_answered_alike_after_far_ones():
    for mesh in MESHES.values():
        surface, points = SurfaceIndex(mesh), mesh.vertices[:100] * 1.01
        before = surface.nearest(points)[0]
        surface.nearest([[1e3, 0, 0]])
        assert (surface.nearest(points)[0] == before).all()


def test_flat_meshes_and_meshes_far_from_the_origin_are_measured():
    flat = Mesh(SPHERE.vertices * [1, 1, 0], SPHERE.faces)
    moved = Mesh(flat.vertices + [1e4, 0, 0], flat.faces)
    assert SurfaceIndex(flat).nearest([[0, 0, 0.2], [2, 0, 0]])[0] == pytest.approx([0.2, 1.5], rel=1e-6)
    assert SurfaceIndex(moved).nearest([[1e4, 0, 0.2]])[0] == pytest.approx([0.2], rel=1e-6)


@pytest.mark.slow
def test_long_slanted_faces_do_not_fill_the_grid():
    # Each side of a thin slanted column lies in the boxes of thousands of cells, were the cells as small as elsewhere.
    column = trimesh.creation.cylinder(0.5, 20.0, sections=3000)
    column.apply_transform(trimesh.transformations.rotation_matrix(0.7, [1, 1, 0]))
    surface = SurfaceIndex(Mesh(column.vertices, column.faces))
    assert len(surface.grid[1]) <= 64 * len(column.faces)
    middles = column.triangles_center
    assert surface.nearest(middles + 0.1 * column.face_normals)[0] == pytest.approx(
        np.full(len(middles), 0.1), rel=1e-3
    )


def test_vertex_errors_are_distances_at_the_vertices():
    grown = Mesh(1.1 * SPHERE.vertices, SPHERE.faces)
    found = vertex_errors(SPHERE, grown)
    assert found.shape == (len(grown.vertices),)
    assert found == pytest.approx(np.full(len(found), 0.05), rel=0.01)
    assert vertex_errors(grown, SPHERE).max() <= 0.05
    assert vertex_errors(SPHERE, SPHERE).max() < 1e-15


def test_max_is_over_the_vertices_too():
    # A needle that three samples would not meet.
    vertices = np.r_[SPHERE.vertices, [[0, 0, 5]]]
    spiked = Mesh(vertices, np.r_[SPHERE.faces, [[0, 0, len(SPHERE.vertices)]]])
    nearest = np.linalg.norm([0, 0, 5]) - 0.5
    for pair in ((SPHERE, spiked), (spiked, SPHERE)):
        assert metro(*pair, 3)["max"] * SurfaceIndex(pair[0]).diagonal == pytest.approx(nearest, rel=0.01)


def test_concentric_boxes_have_the_known_errors():
    # From the inner box every point is 0.1 from the outer; an outer point over an edge or corner is farther.
    box = trimesh.creation.box((1, 1, 1))
    inner, outer = Mesh(box.vertices, box.faces), Mesh(1.2 * box.vertices, box.faces)
    found = metro(inner, outer, 20_000)
    over = np.clip(np.abs((np.arange(1000) + 0.5) / 1000 * 1.2 - 0.6) - 0.5, 0, None)
    mean = np.sqrt(0.01 + over[:, None] ** 2 + over**2).mean()
    assert found["mean"] == pytest.approx(mean / np.sqrt(3), rel=2e-3)
    assert found["max"] == pytest.approx(0.1, rel=1e-9)


def test_a_mesh_without_faces_is_named():
    with pytest.raises(ValueError, match="without faces"):
        metro(SPHERE, Mesh(np.zeros((3, 3)), np.zeros((0, 3), dtype=int)))


def test_meshes_and_points_out_of_range_are_named():
    with pytest.raises(ValueError, match="out of range"):
        SurfaceIndex(Mesh(1e120 * SPHERE.vertices, SPHERE.faces))
    for bad in (np.nan, np.inf, 1e200):
        with pytest.raises(ValueError, match="points"):
            SurfaceIndex(SPHERE).nearest([[bad, 0, 0]])


def test_points_far_away_and_points_as_surfaces_are_measured():
    assert SurfaceIndex(SPHERE).nearest([[1e30, 0, 0]])[0] == pytest.approx([1e30])
    assert SurfaceIndex(Mesh(np.ones((3, 3)), [[0, 1, 2]])).nearest([[1, 1, 3], [1, 1, 1]])[0] == pytest.approx([2, 0])
