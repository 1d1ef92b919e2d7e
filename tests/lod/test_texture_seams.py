"""Texture coordinates of a coarse mesh split at the seams of the original and nowhere else."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import simplify
from haptic_glance.lod.attributes import carry
from haptic_glance.lod.seams import Corners, charts, joined
from haptic_glance.lod.topology import NONE, faults
from haptic_glance.mesh.mesh import Mesh, Texture

from .conftest import GREY, sheet, tube

LEFT = 0.1  # u of the chart's left side
TWIST = 2.0  # radians from one end to the other, so that coarse edges cross the seam


def wrapped(width, twist=TWIST):
    """A twisted barrel with one seam, whose chart is `width` wide in a picture of 1."""
    mesh = tube(96, 48)
    x, y, z = mesh.vertices.T
    angle = np.arctan2(y, x)
    radius = 0.3 + 0.1 * np.sin(np.pi * z) + 0.03 * np.sin(5 * angle)
    vertices = np.stack([radius * np.cos(angle + twist * z), radius * np.sin(angle + twist * z), z], axis=1)
    uv = np.array([LEFT, LEFT]) + mesh.texture.uv * (width, 0.5)
    return replace(mesh, vertices=vertices, texture=replace(mesh.texture, uv=uv))


def coarse(mesh, faces=700):
    return carry(mesh, simplify(Mesh(mesh.vertices, mesh.faces), faces))


def turns(points):
    """Shares of the turn from the seam, -0.5 to 0.5."""
    return ((np.arctan2(points[..., 1], points[..., 0]) - TWIST * points[..., 2]) / (2 * np.pi) + 0.5) % 1 - 0.5


def turns_of_corners(mesh):
    """(m, 3) the same of all corners of faces, from 0 to 1 and beyond, continuous within each face."""
    corners = mesh.vertices[mesh.faces]
    turn = turns(corners)
    return turn + np.rint(turns(corners.mean(axis=1))[:, None] % 1 - turn)


def distinct(mesh):
    """(n,) how many pairs of texture coordinates the corners of each vertex have, bit for bit."""
    rows = np.column_stack([mesh.faces.ravel(), mesh.texture.uv.reshape(-1, 2)])
    return np.bincount(np.unique(rows, axis=0)[:, 0].astype(int), minlength=len(mesh.vertices))


@pytest.mark.parametrize("width", [1.0, 0.5])
def test_vertex_has_one_pair_of_coordinates_for_each_side_of_the_seam_that_its_faces_lie_on(width):
    carried = coarse(wrapped(width))
    side = np.rint(turns_of_corners(carried) - turns(carried.vertices)[carried.faces])  # 1 left of the seam, 0 right
    rows = np.unique(np.column_stack([carried.faces.ravel(), side.ravel()]), axis=0)
    expected = np.bincount(rows[:, 0].astype(int), minlength=len(carried.vertices))
    near = np.abs(turns(carried.vertices)) < 0.25  # elsewhere half a turn off the seam is left or right of it
    assert (expected[near] == 2).sum() > 10
    assert np.array_equal(distinct(carried)[near], expected[near])
    assert (distinct(carried)[~near] == 1).all()


@pytest.mark.parametrize("width", [1.0, 0.5])
def test_coordinates_follow_the_surface_and_go_beyond_the_chart_only_where_the_picture_repeats(width):
    carried = coarse(wrapped(width))
    turn, u = turns_of_corners(carried), carried.texture.uv[..., 0]
    assert (turn < -0.002).sum() + (turn > 1.002).sum() > 10
    assert (u - LEFT) / width == pytest.approx(turn if width == 1 else turn.clip(0, 1), abs=0.01)
    assert width == 1 or (u.min() > LEFT - 1e-9 and u.max() < LEFT + width + 1e-9)


def ring(width):
    """A barrel whose chart is a ring in the picture: across its seam coordinates jump by a little, 0.003 to 0.006."""
    mesh = wrapped(width, twist=0.0)
    u, v = (mesh.texture.uv - LEFT).transpose(2, 0, 1)
    angle = 0.99 * 2 * np.pi * u / width
    uv = 0.5 + (0.05 + 0.1 * v)[..., None] * np.stack([np.cos(angle), np.sin(angle)], axis=2)
    return replace(mesh, texture=replace(mesh.texture, uv=uv))


def pairs_of(mesh):
    """{position: the texture coordinates there} of a mesh."""
    pairs = {}
    for vertex, uv in zip(mesh.faces.ravel(), mesh.texture.uv.reshape(-1, 2), strict=True):
        pairs.setdefault(bytes(mesh.vertices[vertex]), set()).add(tuple(uv))
    return pairs


@pytest.mark.parametrize("mesh", [wrapped(1.0, 0.0), wrapped(0.5, 0.0), ring(1.0)], ids=["1", "0.5", "ring"])
def test_vertices_that_stay_keep_their_coordinates(mesh):
    original, result = pairs_of(mesh), pairs_of(coarse(mesh))
    stayed = original.keys() & result.keys()
    assert len(stayed) >= 2 * 96  # the two ends
    assert all(result[position] == original[position] for position in stayed)


def test_corners_of_a_vertex_are_joined_where_the_way_between_their_points_explains_the_gap():
    seams = replace(charts(wrapped(0.5))[1], scale=np.array([2.0]))
    along, u = np.array([0.0, 0.1, 0.1, 0.1, 0.0]), np.array([0.0, 0.3, 0.9, 2.0, 0.0])
    points, uv = np.stack([along, 0 * along, 0 * along], axis=1), np.stack([u, 0 * u], axis=1)
    corners = Corners(np.array([0, 0, 0, 0, 1]), np.zeros(5, dtype=int), points, uv, uv)
    assert joined(seams, corners)[:, 0].tolist() == [0.0, 0.0, 0.9, 2.0, 0.0]


def test_picture_that_is_stretched_unevenly_is_off_to_neither_side_within_coarse_faces():
    mesh = sheet(48, height=0.03)
    plan = mesh.vertices[mesh.faces][..., :2]
    texture = Texture(np.stack([plan[..., 0] ** 2, plan[..., 1]], axis=2), np.zeros(len(plan)), (GREY,))
    carried = carry(replace(mesh, texture=texture), simplify(mesh, 600))
    across = carried.vertices[carried.faces][..., 0]
    inner = ((across > 0.2) & (across < 0.8)).all(axis=1)
    chord = (across**2).mean(axis=1) - across.mean(axis=1) ** 2  # of the parabola, which always lies above it
    off = carried.texture.uv[..., 0].mean(axis=1) - across.mean(axis=1) ** 2
    assert abs(off[inner].mean()) < 0.4 * chord[inner].mean()


def test_seams_over_flat_faces_leave_no_face_without_height():
    body = trimesh.creation.icosphere(2)
    body.vertices *= np.random.default_rng(0).uniform(0.6, 1.4, (len(body.vertices), 1))
    body = body.subdivide().subdivide().subdivide()  # each face of the first body is 64 flat ones
    side = np.abs(body.face_normals).argmax(axis=1)  # a chart for each axis and direction, as a box projection has
    ahead = np.take_along_axis(body.face_normals, side[:, None], axis=1)[:, 0] > 0
    places = np.take_along_axis(body.triangles, np.array([[1, 2], [0, 2], [0, 1]])[side][:, None], axis=2)
    uv = (places / 3 + 0.5) / [3, 2] + np.stack([side / 3, ahead / 2], axis=1)[:, None]
    picture = np.full((4, 4, 4), 200, dtype=np.uint8)
    mesh = Mesh(body.vertices, body.faces, texture=Texture(uv, np.zeros(len(uv), dtype=np.int32), (picture,)))
    for faces in (10_240, 4_096):
        small = simplify(mesh, faces, attributes={"uv": 1.0})
        assert len(small.faces) == faces and faults(small) == NONE
