"""The cut of a mesh by a plane against shapes whose cuts are known, and against trimesh."""

import numpy as np
import pytest
import trimesh

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch.section import MeshCutter
from tests.shapes import mesh_of

ORIGIN, X, Z = np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


BALL = mesh_of(trimesh.creation.icosphere(subdivisions=4, radius=0.5))
RING = mesh_of(trimesh.creation.torus(0.35, 0.15, major_sections=80, minor_sections=40))
BOX = mesh_of(trimesh.creation.box((2.0, 4.0, 6.0)))
SQUARE = Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])


def section(mesh, point, normal):
    return MeshCutter(mesh).cut(point, normal)


def in_order(curve):
    """Whether each segment lies in the face that it names."""
    return curve.faces.shape == curve.steps.shape


def on_edges(mesh, curve):
    a, b = mesh.vertices[curve.edges].transpose(1, 0, 2)
    return np.allclose((1 - curve.weights[:, None]) * a + curve.weights[:, None] * b, curve.points, atol=1e-12)


def test_points_follow_each_other_within_the_face_named():
    (circle,) = section(BALL, (0.01, 0.02, 0.03), (1, 2, 3))
    assert np.abs((circle.points - [0.01, 0.02, 0.03]) @ [1, 2, 3]).max() < 1e-12 and on_edges(BALL, circle)
    after = np.roll(circle.edges, -1, axis=0)
    for face, start, end in zip(BALL.faces[circle.faces], circle.edges, after, strict=True):
        assert set(start) | set(end) == set(face)


def test_a_torus_is_cut_in_two_loops():
    across = section(RING, ORIGIN, X)
    assert [curve.closed for curve in across] == [True, True]
    assert [curve.length for curve in across] == pytest.approx([2 * np.pi * 0.15] * 2, rel=5e-3)
    outer, inner = section(RING, ORIGIN, Z)
    assert (outer.length, inner.length) == pytest.approx((2 * np.pi * 0.5, 2 * np.pi * 0.2), rel=5e-3)


def test_a_plane_through_vertices_and_edges_gives_whole_loops():
    (diagonal,) = section(BOX, ORIGIN, (2, -1, 0))  # through four vertices and two edges of the box
    assert diagonal.closed and diagonal.length == pytest.approx(2 * (6 + np.hypot(2, 4)))
    (equator,) = section(BALL, ORIGIN, Z)  # an icosphere has vertices there
    assert equator.closed and np.isfinite(equator.points).all()


def test_a_plane_in_a_face_is_moved_by_less_than_any_number_against_its_normal():
    (top,) = section(BOX, (0, 0, 3), Z)
    assert top.closed and top.length == pytest.approx(12.0)
    assert section(BOX, (0, 0, 3), -Z) == []


def test_a_plane_that_misses_gives_nothing():
    assert section(BALL, (0, 0, 0.7), Z) == []
    assert section(Mesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=int)), ORIGIN, Z) == []


def test_an_open_mesh_gives_a_line_from_rim_to_rim():
    (line,) = section(SQUARE, (0.5, 0.3, 0), (0, 1, 0))
    assert not line.closed and line.length == pytest.approx(1.0)
    assert sorted(line.points[[0, -1], 0]) == [0.0, 1.0] and in_order(line)
    half = Mesh(BALL.vertices, BALL.faces[BALL.vertices[BALL.faces].mean(axis=1)[:, 2] > 0])
    (arc,) = section(half, ORIGIN, X)
    assert not arc.closed and arc.length == pytest.approx(np.pi * 0.5, rel=0.05)


def test_an_edge_of_three_faces_ends_a_line_and_one_of_four_does_not():
    spokes = [(1, 0), (0, 1), (-1, 0), (0, -1)]
    corners = [[0, 0, 0], [0, 0, 1], *[[x, y, 0.5] for x, y in spokes]]
    for count, curves in ((2, 1), (3, 2), (4, 2)):
        fan = Mesh(corners, [[0, 1, 2 + i] for i in range(count)])
        lines = section(fan, (0, 0, 0.4), Z)
        assert len(lines) == curves
        assert sum(curve.length for curve in lines) == pytest.approx(0.8 * count)


def test_neither_a_seam_of_doubled_vertices_nor_a_turned_face_ends_a_loop():
    soup = Mesh(BALL.vertices[BALL.faces].reshape(-1, 3), np.arange(3 * len(BALL.faces)).reshape(-1, 3))
    turned = BALL.faces.copy()
    turned[::3] = turned[::3, ::-1]
    (plain,) = section(BALL, ORIGIN, (1, 2, 3))
    for mesh in (soup, Mesh(BALL.vertices, turned)):
        (loop,) = section(mesh, ORIGIN, (1, 2, 3))
        assert loop.closed and loop.length == pytest.approx(plain.length) and on_edges(mesh, loop)


def test_every_crossed_face_of_a_soup_is_walked_once_and_in_its_place():
    rng = np.random.default_rng(0)
    for _ in range(60):
        corners = rng.integers(0, 3, size=(8, 3)).astype(float)  # many at one place, on the plane, in one line
        faces = rng.integers(0, 8, size=(15, 3))
        soup = Mesh(corners, faces[(np.sort(faces)[:, 1:] != np.sort(faces)[:, :-1]).all(axis=1)])
        normal = rng.integers(-1, 2, size=3) + [0, 0, 2]
        curves = section(soup, (1, 1, 1), normal)
        sides = ((corners - 1) @ normal >= 0)[soup.faces].sum(axis=1)
        walked = np.concatenate([curve.faces for curve in curves]) if curves else np.zeros(0, dtype=int)
        assert len(set(walked.tolist())) == len(walked) and np.isin(sides[walked], [1, 2]).all()
        left = np.setdiff1d(np.flatnonzero(np.isin(sides, [1, 2])), walked)
        assert (soup.face_areas[left] == 0).all()
        for curve in curves:
            assert on_edges(soup, curve) and in_order(curve) and np.isfinite(curve.points).all()


def test_backwards_names_the_same_faces_and_starts_at_the_same_point():
    (circle,) = section(BALL, ORIGIN, (1, 2, 3))
    back = circle.backwards()
    assert np.array_equal(back.points[0], circle.points[0]) and np.array_equal(back.points[1], circle.points[-1])
    assert np.array_equal(back.faces, circle.faces[::-1]) and np.allclose(back.steps, circle.steps[::-1])
    (line,) = section(SQUARE, (0.5, 0.3, 0), (0, 1, 0))
    assert np.array_equal(line.backwards().points, line.points[::-1])


def test_agrees_with_trimesh():
    bumps = 1 + 0.2 * np.sin(9 * RING.vertices[:, [1, 2, 0]])
    mesh = Mesh(RING.vertices * bumps, RING.faces)
    peer = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    for normal in np.random.default_rng(0).normal(size=(5, 3)):
        curves = section(mesh, ORIGIN, normal)
        lines = trimesh.intersections.mesh_plane(peer, normal, ORIGIN)
        expected = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).sum()
        assert sum(curve.length for curve in curves) == pytest.approx(expected, rel=1e-5)
        assert len(curves) == len(peer.section(normal, ORIGIN).discrete)


@pytest.mark.parametrize(("gap", "closed"), [(1e-4, True), (1e-2, False)])
def test_a_crack_that_no_finger_feels_does_not_end_a_loop(gap, closed):
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    right = ball.triangles_center[:, 0] > 0
    vertices = np.concatenate([ball.vertices, ball.vertices + [gap, 0, 0]])
    faces = ball.faces + len(ball.vertices) * right[:, None]
    curves = section(Mesh(vertices, faces), [0, 0, 0.01], [0, 0, 1])
    assert (len(curves) == 1 and curves[0].closed) == closed
    assert sum(curve.length for curve in curves) == pytest.approx(np.pi, rel=0.02)
