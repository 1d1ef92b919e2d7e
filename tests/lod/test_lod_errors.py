"""Errors of surfaces: against shapes whose distance is known, two libraries, and damage whose place is known."""

import numpy as np
import point_cloud_utils
import pytest
import trimesh

from haptic_glance.lod.errors import metro, salient_error, surface_errors, vertex_errors
from haptic_glance.mesh.kernels.nearest import cell_boxes
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.nearest import SurfaceIndex

from .conftest import ball, sheet

SPHERE = ball(3)


def square(height=0.0, side=1.0):
    corners = np.array([[0, 0, height], [side, 0, height], [side, side, height], [0, side, height]])
    return Mesh(corners, [[0, 1, 2], [0, 2, 3]])


def test_parallel_planes_are_their_distance_apart():
    errors = metro(square(), square(0.25), 500)
    assert errors == pytest.approx(dict.fromkeys(("mean", "rms", "max"), 0.25 / np.sqrt(2)), rel=1e-12)


def test_no_face_is_put_into_a_cell_outside_the_grid():
    index = SurfaceIndex(SPHERE)
    *_, low, cell, shape = index.grid
    for vertices in (9 * SPHERE.vertices, 1e300 * SPHERE.vertices, np.full_like(SPHERE.vertices, np.nan)):
        boxes, total = cell_boxes(vertices, SPHERE.faces, low, cell, shape)
        assert boxes.min() >= 0 and (boxes < np.tile(shape, 2)).all()
        assert total == np.prod(boxes[:, 3:] - boxes[:, :3] + 1, axis=1).sum()


def test_larger_of_both_directions_counts():
    # All of the small square lies on the large one, not the other way round: the far corner is sqrt(2) / 2 away.
    small, large = square(side=0.5), square()
    assert metro(large, small, 500)["max"] == pytest.approx(0.5, rel=1e-12)
    assert metro(small, large, 500)["max"] == pytest.approx(1.0, rel=1e-12)
    for name in ("mean", "rms"):
        assert metro(small, large, 500)[name] == pytest.approx(2 * metro(large, small, 500)[name], rel=0.1)
        assert metro(large, small, 500)[name] > 0.1


def test_samples_are_even_by_area():
    mesh = Mesh(np.r_[square().vertices, square(1, 3).vertices], np.r_[square().faces, square().faces + 4])
    points = SurfaceIndex(mesh).sample(1000, np.random.default_rng(0))[0]
    assert (points[:, 2] == 0).sum() == pytest.approx(100, abs=1)
    upper = points[points[:, 2] == 1]
    assert (upper[:, :2].mean(axis=0) == pytest.approx(1.5, abs=0.1)) and upper.max() <= 3


def waves():
    """A wavy sheet whose cells are long and thin."""
    mesh = sheet(24, height=0.1)
    return Mesh(mesh.vertices * [1, 0.1, 1], mesh.faces)


def soup():
    """Triangles of all sizes thrown about, some of them needles, two far apart from the rest."""
    generator = np.random.default_rng(0)
    corners = generator.normal(size=(300, 1, 3)) + generator.exponential(0.2, (300, 1, 1)) * generator.normal(
        size=(300, 3, 3)
    )
    corners[:20, 2] = corners[:20, 1] + 1e-9 * corners[:20, 0]
    corners[-2:] += 50
    return Mesh(corners.reshape(-1, 3), np.arange(900).reshape(-1, 3))


MESHES = {"sphere": SPHERE, "waves": waves(), "soup": soup(), "one triangle": Mesh(np.eye(3), [[0, 1, 2]])}


@pytest.mark.parametrize("name", MESHES)
def test_distances_agree_with_point_cloud_utils_and_weights_name_the_nearest_place(name):
    mesh, spread = MESHES[name], np.repeat([1.0, 1.05, 0.0, 3.0, 100.0], 60)[:, None]
    noise = np.random.default_rng(1).normal(size=(300, 3))
    points = spread * mesh.vertices[np.arange(300) % len(mesh.vertices)] + 0.02 * noise
    expected, _, _ = point_cloud_utils.closest_points_on_mesh(points, mesh.vertices, mesh.faces)
    surface = SurfaceIndex(mesh)
    distances, faces = surface.nearest(points)
    assert distances == pytest.approx(expected, rel=1e-9, abs=1e-12)
    weights = surface.weights(points, faces)  # of the corners of the face that is named
    assert weights.min() >= 0 and weights.sum(axis=1) == pytest.approx(np.ones(300))
    place = np.einsum("ij,ijk->ik", weights, mesh.vertices[mesh.faces[faces]])
    assert np.linalg.norm(points - place, axis=1) == pytest.approx(distances, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("height", [1e-2, 1e-8, 1e-13, 0.0])
@pytest.mark.parametrize("foot", [0.3, -0.5])
def test_needles_are_as_far_as_their_sides_at_most_their_height_less(height, foot):
    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    corners = np.array([[0, 0, 0], [1, 0, 0], [foot, height, 0]]) @ turn + 0.1
    along, up = np.meshgrid([-2, -1e-3, 0, 0.2, 0.5, 0.999, 1, 1 + 1e-6, 2], [0, 1e-9, 1e-3, 1])
    places = np.stack([along.ravel(), np.zeros(36), up.ravel()], axis=1)
    low, high = min(foot, 0), max(foot, 1)
    expected = np.hypot(places[:, 0] - places[:, 0].clip(low, high), places[:, 2])
    distances, _ = SurfaceIndex(Mesh(corners, [[0, 1, 2]])).nearest(places @ turn + 0.1)
    assert np.abs(distances - expected).max() <= height + 1e-12


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
    errors = vertex_errors(SPHERE, grown)
    assert errors.shape == (len(grown.vertices),)
    assert errors == pytest.approx(np.full(len(errors), 0.05), rel=0.01)
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
    errors = metro(inner, outer, 20_000)
    over = np.clip(np.abs((np.arange(1000) + 0.5) / 1000 * 1.2 - 0.6) - 0.5, 0, None)
    squares = 0.01 + over[:, None] ** 2 + over**2
    assert errors["mean"] == pytest.approx(np.sqrt(squares).mean() / np.sqrt(3), rel=2e-3)
    assert errors["rms"] == pytest.approx(np.sqrt(squares.mean()) / np.sqrt(3), rel=2e-3)
    assert errors["max"] == pytest.approx(0.1, rel=1e-9)


UPPER = (SPHERE.vertices[:, 2] > 0.25).astype(float)


def dented(side):
    """The sphere with the cap of one side, +1 above or -1 below, pressed in by a tenth."""
    vertices = SPHERE.vertices.copy()
    cap = side * vertices[:, 2] > 0.35
    vertices[cap] *= 0.9
    return Mesh(vertices, SPHERE.faces)


def test_equal_saliency_is_metro_and_the_seed_decides():
    errors = surface_errors(SPHERE, dented(1), {"salient": np.full(len(UPPER), 7.0)}, 2000, seed=3)
    known = metro(SPHERE, dented(1), 2000, seed=3)
    assert errors.pop("salient") == pytest.approx(known["mean"], rel=1e-12) and errors == known
    assert known != metro(SPHERE, dented(1), 2000, seed=4)
    assert max(surface_errors(SPHERE, SPHERE, {"salient": UPPER}, 1000).values()) < 1e-15


def test_a_tilted_plane_is_weighted_by_the_saliency_there():
    # Height 0.1 x over a square whose saliency is x: the mean of x weighted by x is 2 / 3; the tilt shortens it.
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    flat = Mesh(corners, [[0, 1, 2], [0, 2, 3]])
    tilted = Mesh(corners + 0.1 * corners[:, :1] * [0, 0, 1], flat.faces)
    expected = 0.1 * 2 / 3 / np.sqrt(2)
    assert salient_error(flat, tilted, corners[:, 0], 20_000) == pytest.approx(expected, rel=0.02)


def test_scale_of_the_saliency_and_of_the_meshes_does_not_matter():
    saliency, damaged = np.random.default_rng(0).random(len(UPPER)), dented(1)
    value = salient_error(SPHERE, damaged, saliency, 1000)
    larger = [Mesh(4 * mesh.vertices, mesh.faces) for mesh in (SPHERE, damaged)]
    assert salient_error(*larger, 10 * saliency, 1000) == pytest.approx(value, rel=1e-12)


EMPTY = Mesh(np.zeros((3, 3)), np.zeros((0, 3), dtype=int))


@pytest.mark.parametrize(
    ("work", "words"),
    [
        (lambda: metro(SPHERE, SPHERE, 0), "samples"),
        (lambda: metro(SPHERE, Mesh(np.zeros((3, 3)), [[0, 1, 2]])), "area"),
        (lambda: metro(SPHERE, EMPTY), "without faces"),
        (lambda: SurfaceIndex(Mesh(1e120 * SPHERE.vertices, SPHERE.faces)), "out of range"),
        (lambda: SurfaceIndex(SPHERE).nearest([[np.nan, 0, 0]]), "points"),
        (lambda: SurfaceIndex(SPHERE).nearest([[1e200, 0, 0]]), "points"),
        (lambda: salient_error(SPHERE, SPHERE, np.eye(len(UPPER))[0], 3), "more samples"),
        (lambda: salient_error(SPHERE, SPHERE, 0 * UPPER, 100), "zero on the whole surface"),
        (lambda: salient_error(SPHERE, SPHERE, np.ones(3), 100), "one value per vertex"),
        (lambda: salient_error(SPHERE, SPHERE, -UPPER, 100), "0 or more"),
        (lambda: salient_error(SPHERE, SPHERE, np.nan * UPPER, 100), "finite"),
    ],
)
def test_what_cannot_be_measured_is_named(work, words):
    with pytest.raises(ValueError, match=words):
        work()


def test_points_far_away_and_flat_meshes_and_points_as_surfaces_are_measured():
    surface = SurfaceIndex(SPHERE)
    near = surface.nearest(1.01 * SPHERE.vertices)[0]
    assert surface.nearest([[1e30, 0, 0]])[0] == pytest.approx([1e30])
    assert (surface.nearest(1.01 * SPHERE.vertices)[0] == near).all()
    flat = Mesh(SPHERE.vertices * [1, 1, 0] + [1e4, 0, 0], SPHERE.faces)
    assert SurfaceIndex(flat).nearest([[1e4, 0, 0.2], [1e4 + 2, 0, 0]])[0] == pytest.approx([0.2, 1.5], rel=1e-6)
    assert SurfaceIndex(Mesh(np.ones((3, 3)), [[0, 1, 2]])).nearest([[1, 1, 3], [1, 1, 1]])[0] == pytest.approx([2, 0])
