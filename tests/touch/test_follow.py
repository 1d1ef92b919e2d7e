"""Contour following on shapes whose contours are known."""

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, contour, follow, follow_many, press_at
from tests.shapes import mesh_of

CELLS, ORIGIN = (8, 8), np.zeros(3)


BALL = mesh_of(trimesh.creation.icosphere(subdivisions=4, radius=0.5))
RING = mesh_of(trimesh.creation.torus(0.35, 0.15, major_sections=80, minor_sections=40))
BOX = mesh_of(trimesh.creation.box((0.4, 0.6, 0.2)))
CUP = mesh_of(trimesh.creation.annulus(0.3, 0.45, 0.4))
LEVEL = np.array([ORIGIN, [0.5, 0, 0], [0.3, 0.4, 0]])
UPRIGHT = np.array([ORIGIN, [0.3, 0, 0.05], [0, 0, 0.2]])
ROTATION = Rotation.from_euler("xyz", [0.4, -1.1, 2.0]).as_matrix()


def test_frames_are_equally_spaced_round_a_sphere():
    sequence = follow(BALL, LEVEL, frames=10, cells=CELLS)
    assert (
        sequence.length == pytest.approx(np.pi, rel=3e-3) and sequence.loops == 1 and sequence.share == pytest.approx(1)
    )
    angles = np.unwrap(np.arctan2(sequence.positions[:, 1], sequence.positions[:, 0]))
    assert np.allclose(angles - angles[0], np.arange(10) * np.pi / 5, atol=0.01)
    assert np.allclose(sequence.positions[:, 2], 0, atol=1e-12)
    assert np.allclose(sequence.normals, sequence.positions / 0.5, atol=0.03)
    assert sequence.images.shape == (10, *CELLS) and sequence.images.dtype == np.float32
    assert sequence.images.min() == 0 and sequence.images.max() == 1
    assert sequence.normals.shape == sequence.positions.shape == (10, 3) and (sequence.pitches == 0.01).all()


def test_it_begins_at_the_first_point_and_goes_towards_the_second():
    sequence = follow(BALL, LEVEL, frames=40, cells=CELLS)
    assert np.linalg.norm(sequence.positions[0] - LEVEL[1]) < 0.01
    assert sequence.positions[1, 1] > 0
    back = follow(BALL, LEVEL[[0, 2, 1]], frames=40, cells=CELLS)
    assert np.linalg.norm(back.positions[0] - LEVEL[2]) < 0.01
    assert np.linalg.norm(back.positions[1] - LEVEL[1]) < np.linalg.norm(back.positions[0] - LEVEL[1])


def test_the_normal_turns_over_one_pitch_at_an_edge():
    sequence = follow(BOX, UPRIGHT, frames=200, cells=CELLS, pitch=0.02)
    away = np.linalg.norm(np.abs(sequence.positions[:, [0, 2]]) - [0.2, 0.1], axis=1)
    bent = np.abs(sequence.normals).max(axis=1) < 1 - 1e-9
    assert bent.any() and (away[bent] < 0.02 + 1e-9).all() and (away[~bent] > 0.02 - 1e-9).all()


def test_beyond_the_ends_of_an_open_curve_no_normal_counts():
    angles = np.linspace(0, np.pi, 41)
    rim = np.column_stack([0.5 * np.cos(angles), 0.5 * np.sin(angles)])
    vertices = np.vstack([np.column_stack([rim, np.full(41, height)]) for height in (-0.3, 0.3)])
    low = np.arange(40)
    half = Mesh(
        vertices, np.vstack([np.column_stack([low, low + 1, low + 41]), np.column_stack([low + 1, low + 42, low + 41])])
    )
    sequence = follow(half, [[0, 0.2, 0], [0.5, 0.01, 0], [-0.5, 0.01, 0]], frames=60, cells=CELLS, pitch=0.05)
    assert sequence.length == pytest.approx(np.pi / 2, rel=1e-3)
    outward = sequence.positions / np.linalg.norm(sequence.positions, axis=1, keepdims=True)
    off = np.degrees(np.arccos(np.clip(np.einsum("ij,ij->i", sequence.normals, outward), -1, 1)))
    assert off.max() < 5  # half of the width, 0.025, is 2.9 degrees of the cylinder, and half of a face 2.25


def test_the_longest_loop_is_followed_and_the_others_are_counted():
    plane = [ORIGIN, [0.5, 0, 0.0], [0, 0.5, 0.0]]
    sequence = follow(RING, plane, cells=CELLS)
    assert sequence.loops == 2 and sequence.length == pytest.approx(np.pi, rel=5e-3)
    assert sequence.share == pytest.approx(0.5 / 0.7, rel=5e-3)
    inner = follow(RING, [ORIGIN, [0.2, 0, 0], [0, 0.2, 0]], cells=CELLS)
    assert inner.length == pytest.approx(sequence.length)


def test_row_0_is_ahead_and_the_images_turn_and_scale_with_the_object():
    plane = np.array([[0.01, 0.02, 0.03], [0.31, 0.04, 0.05], [0.1, 0.03, 0.2]])
    plain = follow(RING, plane, cells=(6, 10))
    turned = Mesh(100 * RING.vertices @ ROTATION.T + 500, RING.faces)
    moved = follow(turned, 100 * plane @ ROTATION.T + 500, cells=(6, 10), pitch=1.0)
    assert np.allclose(moved.images, plain.images, atol=1e-4) and moved.length == pytest.approx(100 * plain.length)
    assert np.allclose(moved.normals, plain.normals @ ROTATION.T, atol=1e-9)


def test_images_are_those_of_the_array_held_along_the_way():
    sequence = follow(RING, UPRIGHT, frames=12, cells=CELLS)
    across = np.cross(UPRIGHT[1], UPRIGHT[2])
    across /= np.linalg.norm(across)
    up = np.cross(across, sequence.normals)
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    way = np.roll(sequence.positions, -1, axis=0) - np.roll(sequence.positions, 1, axis=0)
    up *= np.sign(np.einsum("ij,ij->i", up, way))[:, None]
    axes = np.stack([np.cross(up, sequence.normals), up, sequence.normals], axis=1)
    expected = press_at(Surface(RING), sequence.positions, axes, CELLS, sequence.pitches)
    assert np.abs(expected - sequence.images).mean() < 0.01


def test_the_contour_is_that_of_the_sequence_in_its_direction():
    sequence, loop = follow(RING, UPRIGHT, cells=CELLS), contour(RING, UPRIGHT)
    assert loop.length == sequence.length
    turn = np.cross(loop.points - loop.points.mean(axis=0), np.roll(loop.points, -1, axis=0) - loop.points)
    assert turn.sum(axis=0) @ np.cross(UPRIGHT[1], UPRIGHT[2]) > 0


def test_a_straight_contour_leads_from_the_first_point_to_the_second():
    sheet = mesh_of(trimesh.creation.box((0.8, 0.6, 0.2)))
    top = (sheet.vertices[sheet.faces][:, :, 2] > 0).all(axis=1)
    points = np.array([[0, 0, 0.1], [0.3, 0.1, 0.1], [-0.2, -0.05, 0.3]])
    for turn in Rotation.random(20, random_state=0).as_matrix():
        flat = Mesh(sheet.vertices @ turn.T, sheet.faces[top])
        line = contour(flat, points @ turn.T).points @ turn
        assert (line[-1] - line[0]) @ (points[2] - points[1]) > 0


def test_the_array_shrinks_inside_a_narrow_ring():
    inside = follow(CUP, [ORIGIN, [0.3, 0, 0.1], [0, 0, 0.2]], pitch=0.03)
    assert inside.pitches.min() < 0.03 == inside.pitches.max()


def test_many_planes_give_what_each_gives():
    rng = np.random.default_rng(0)
    planes = np.concatenate([np.zeros((4, 1, 3)), rng.normal(size=(4, 2, 3))], axis=1)
    many = follow_many(RING, planes, frames=5, cells=CELLS)
    for plane, sequence in zip(planes, many, strict=True):
        alone = follow(RING, plane, frames=5, cells=CELLS)
        for part in ("images", "normals", "positions", "pitches", "loops", "length", "share"):
            assert np.array_equal(getattr(alone, part), getattr(sequence, part))


def test_rounding_says_nothing_about_the_way_at_the_vertex_where_a_contour_begins():
    ball = trimesh.creation.icosphere(subdivisions=2)
    corners, faces, rng = ball.vertices * [0.5, 0.3, 0.2], ball.faces, np.random.default_rng(1)
    pairs = rng.choice(len(corners) // 2, (40, 2), replace=False)
    planes = np.concatenate([np.zeros((40, 1, 3)), corners[pairs]], axis=1)
    order = rng.permutation(len(corners))
    other = Mesh(corners[order], np.argsort(order)[faces][rng.permutation(len(faces))])
    sequences, again = (follow_many(mesh, planes, frames=3, cells=CELLS) for mesh in (Mesh(corners, faces), other))
    # Single cells at the outline may be hit or missed; an array that is turned differs in most.
    unlike = [np.mean(np.abs(a.images[0] - b.images[0]) > 1e-3) for a, b in zip(sequences, again, strict=True)]
    assert max(unlike) < 0.1


@pytest.mark.parametrize(
    "points, changes, message",
    [
        ([ORIGIN, [0, 0, 0], [1, 0, 0]], {}, "coincide"),
        ([ORIGIN, [1, 0, 0], [1, 0, 0]], {}, "lie on a line"),
        ([ORIGIN, [1, 1e-7, 0], [-2, 0, 0]], {}, "lie on a line"),
        ([[0, 0, 0.6], [1, 0, 0.6], [0, 1, 0.6]], {}, "misses the mesh"),
        ([[0, 0], [1, 0], [0, 1]], {}, "a plane must be"),
        ([ORIGIN, [np.nan, 0, 0], [0, 1, 0]], {}, "a plane must be"),
        (LEVEL, {"frames": 0}, "must be"),
        (LEVEL, {"frames": 2.5}, "must be"),
        (LEVEL, {"frames": np.nan}, "must be"),
        (LEVEL, {"frames": None}, "frames must be a whole number from 1, got None"),
        (LEVEL, {"cells": (0, 8)}, "must be"),
        (LEVEL, {"cells": ("8", "8")}, "cells must be two whole numbers from 1"),
        (LEVEL, {"pitch": 0.0}, "must be"),
    ],
)
def test_bad_planes_and_settings_are_named(points, changes, message):
    with pytest.raises(ValueError, match=message):
        follow(BALL, points, **{"cells": CELLS} | changes)


def test_broken_meshes_give_finite_sequences_or_a_reason():
    rng = np.random.default_rng(1)
    sheet = Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    thin = Mesh(sheet.vertices, np.r_[sheet.faces, sheet.faces[:, ::-1]])
    triangle = Mesh(np.eye(3), [[0, 1, 2]])
    inward = Mesh(BALL.vertices, BALL.faces[:, ::-1])
    overlapping = Mesh(np.r_[BALL.vertices, BALL.vertices + 3], np.r_[BALL.faces, BALL.faces + len(BALL.vertices)])
    for mesh in (sheet, thin, triangle, inward, overlapping, Mesh(np.eye(3), np.zeros((0, 3), dtype=int))):
        planes = rng.normal(size=(6, 3, 3)) * 0.3 + mesh.vertices.mean(axis=0)
        for sequence in follow_many(mesh, planes, frames=5, cells=CELLS):
            if not isinstance(sequence, str):
                parts = (sequence.images, sequence.normals, sequence.positions, sequence.pitches)
                assert all(np.isfinite(part).all() for part in parts)
                assert np.allclose(np.linalg.norm(sequence.normals, axis=1), 1)


@pytest.mark.parametrize("shape", [
    trimesh.creation.torus(1, 0.35), trimesh.creation.box((1, 0.7, 0.5)).subdivide(),
])  # fmt: skip
def test_a_contour_along_edges_turns_with_the_object(shape):
    plane = np.array([(0, 0, 0), (1.35, 0.1, 0), (0.1, 1.35, 0)])
    first = follow(mesh_of(shape), plane, cells=(8, 8))
    assert abs(first.normals[:, 2]).max() < 1e-6  # half of the shape lies on either side
    for state in range(4):
        turn = Rotation.random(random_state=state).as_matrix()
        again = follow(Mesh(shape.vertices @ turn.T, shape.faces), plane @ turn.T, cells=(8, 8))
        assert first.normals @ turn.T == pytest.approx(again.normals, abs=1e-6)
        assert first.images == pytest.approx(again.images, abs=1e-4)
