"""Degenerate faces, flips, seams, borders, tips: the result is sound, or the error says why.

Some kinds of input are those of the tests of meshoptimizer's own simplifier (MIT licence); the meshes are our own.
"""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from haptic_glance.lod import (
    InfeasibleTarget,
    SimplifyError,
    frozen_faces,
    metro,
    shrunk_rings,
    simplify,
    smallest_feasible,
)
from haptic_glance.lod.errors import vertex_errors
from haptic_glance.lod.export import shown_mesh
from haptic_glance.lod.topology import faults, topology
from haptic_glance.mesh.mesh import Mesh

from .conftest import sheet

SMALL = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
RING = trimesh.creation.torus(0.35, 0.12, major_sections=20, minor_sections=10)
SPIKE = [[0.0, 0.0, 0.9]]


def finned():
    """A ball with a fin on one of its edges: that edge has three faces."""
    return Mesh(np.r_[SMALL.vertices, SPIKE], np.r_[SMALL.faces, [[*SMALL.faces[0, :2], len(SMALL.vertices)]]])


MESHES = {
    "ball": Mesh(SMALL.vertices, SMALL.faces),
    "torus": Mesh(RING.vertices, RING.faces),
    "open sheet": sheet(11, height=0.1),
    "flat sheet": Mesh(sheet(11, height=0.1).vertices * [1, 1, 0], sheet(11, height=0.1).faces),
    "two components far apart": Mesh(
        np.r_[SMALL.vertices, SMALL.vertices * 0.01 + [40, 0, 0]], np.r_[SMALL.faces, SMALL.faces + len(SMALL.vertices)]
    ),
    "inward normals": Mesh(SMALL.vertices, SMALL.faces[:, ::-1]),
    "three faces on an edge": finned(),
    "a vertex in no face": Mesh(np.r_[SMALL.vertices, SPIKE], SMALL.faces),
    "coincident vertices": Mesh(SMALL.vertices[SMALL.faces].reshape(-1, 3), np.arange(SMALL.faces.size).reshape(-1, 3)),
    "doubled face": Mesh(SMALL.vertices, np.r_[SMALL.faces, SMALL.faces[:1]]),
    "faces without area": Mesh(
        np.r_[SMALL.vertices, [[2.0, 0, 0], [2, 0, 0], [2, 0, 0], [2.1, 0, 0], [2.2, 0, 0]]],
        np.r_[SMALL.faces, [[0, 0, 1], [2, 2, 2], [162, 163, 164], [162, 165, 166]]],  # and of vertices on a line
    ),
    "one triangle": Mesh(np.eye(3), [[0, 1, 2]]),
    "tetrahedron": Mesh(np.r_[np.eye(3), [[0, 0, 0]]], [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]),
}


def check_sound(mesh, simplified, faces, keep, rings):
    assert len(simplified.faces) <= max(faces, 1)
    assert np.isfinite(simplified.vertices).all()
    assert not faults(simplified).added(faults(mesh))
    before, after = topology(mesh.faces), topology(simplified.faces)
    assert (after.components, after.closed_components, after.boundary_edges, after.boundary_loops) == (
        before.components, before.closed_components, before.boundary_edges, before.boundary_loops,
    )  # fmt: skip
    held = {place.tobytes() for place in simplified.vertices}
    edges, counts = mesh.edge_counts
    kept = np.union1d(mesh.faces[frozen_faces(mesh, keep, rings)], edges[counts == 1])  # no crack opens at a border
    assert all(mesh.vertices[vertex].tobytes() in held for vertex in kept)


@pytest.mark.slow
@pytest.mark.parametrize("name", MESHES)
@settings(max_examples=6, deadline=None, derandomize=True)
@given(data=st.data())
def test_any_kept_set_and_any_target_give_a_sound_mesh_or_a_reason(name, data):
    mesh = MESHES[name]
    total, n = len(mesh.faces), len(mesh.vertices)
    keep = data.draw(st.lists(st.integers(0, n - 1), max_size=12, unique=True), "keep")
    rings = np.array([data.draw(st.integers(-1, 4), "rings") for _ in keep], dtype=int)
    faces, shrink = data.draw(st.integers(1, total), "faces"), data.draw(st.booleans(), "shrink")
    try:
        simple = simplify(mesh, faces, keep, rings, shrink=shrink)
    except InfeasibleTarget as error:
        assert error.smallest > faces
        return
    except SimplifyError as error:
        assert "new" in str(error)
        return
    if shrink:
        rings = shrunk_rings(mesh, faces, keep, rings)
    if faces < total:
        check_sound(mesh, simple, faces, keep, rings)
    else:
        assert simple is mesh


@pytest.mark.parametrize("name", MESHES)
def test_everything_kept_leaves_the_mesh_or_is_infeasible(name):
    mesh = MESHES[name]
    everything = np.unique(mesh.faces)
    assert smallest_feasible(mesh, everything) == len(mesh.faces)
    assert simplify(mesh, len(mesh.faces), everything) is mesh
    if len(mesh.faces) > 1:
        with pytest.raises(InfeasibleTarget) as caught:
            simplify(mesh, len(mesh.faces) - 1, everything)
        assert caught.value.smallest == caught.value.frozen == len(mesh.faces)


def normals_up(mesh):
    return mesh.face_crosses[:, 2] / np.linalg.norm(mesh.face_crosses, axis=1)


def test_slivers_within_the_surface_do_no_harm():
    mesh = sheet(15)
    row = (np.arange(len(mesh.vertices)) // 16) == 7
    thin = Mesh(mesh.vertices + np.c_[row * (1 / 15 - 1e-9), np.zeros((len(row), 2))], mesh.faces)  # next to row 8
    simple = simplify(thin, 150)
    assert normals_up(simple).min() > 0.999 and simple.face_areas.sum() == pytest.approx(1)


@pytest.mark.parametrize("faces", [400, 90])
def test_no_face_of_a_flat_sheet_turns_over(faces):
    # A comb: all collapses are free of cost, and next to its inner corners many turn faces over.
    mesh = sheet(23)
    x, y = mesh.vertices[mesh.faces].mean(axis=1)[:, :2].T
    comb = Mesh(mesh.vertices, mesh.faces[(y < 0.4) | (x * 23 % 6 < 3)])
    try:
        simple = simplify(comb, faces)
    except InfeasibleTarget as error:
        simple = simplify(comb, error.smallest)
    assert (normals_up(simple) > 0.999).all()
    assert simple.face_areas.sum() == pytest.approx(comb.face_areas.sum())


def test_a_patch_of_reversed_faces_stays_whole():
    # Where two neighbours wind against each other the surface has no side: the edge stays as a border does.
    mesh = sheet(19)
    patch = (np.abs(mesh.vertices[mesh.faces].mean(axis=1)[:, :2] - 0.5) < 0.2).all(axis=1)
    faces = np.where(patch[:, None], mesh.faces[:, ::-1], mesh.faces)
    simple = simplify(Mesh(mesh.vertices, faces), 400)
    down = normals_up(simple) < 0
    assert simple.face_areas[down].sum() == pytest.approx(mesh.face_areas[patch].sum())
    assert simple.face_areas.sum() == pytest.approx(1) and len(simple.faces) <= 400
    rim = np.unique(mesh.faces[patch])[np.isin(np.unique(mesh.faces[patch]), mesh.faces[~patch])]
    assert {tuple(place) for place in mesh.vertices[rim]} <= {tuple(place) for place in simple.vertices}


def test_a_vertex_kept_on_one_side_of_a_seam_is_kept_on_both():
    mesh = sheet(16)
    right = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 0.5
    n = len(mesh.vertices)
    cut = Mesh(np.r_[mesh.vertices, mesh.vertices], np.where(right[:, None], mesh.faces + n, mesh.faces))
    on_seam = 8 * 17 + 8
    for kept in (on_seam, on_seam + n):
        simple = simplify(cut, 260, [kept], 0)
        assert (simple.vertices == mesh.vertices[on_seam]).all(axis=1).sum() == 2


RADIUS = 0.3


def spiky_ball(length, width):
    """A ball of 20,480 faces with twelve cones, and the ids of their tips.

    length: of a cone, in radii of the ball; width: the angle in radians from its axis to its rim.
    """
    ball, axes = trimesh.creation.icosphere(5), trimesh.creation.icosphere(0).vertices
    angles = np.arccos(np.clip(ball.vertices @ axes.T, -1, 1))
    height = 1 + length * np.clip(1 - angles.min(axis=1) / width, 0, None)
    return Mesh(RADIUS * height[:, None] * ball.vertices, ball.faces), angles.argmin(axis=0)


def test_no_tip_is_cut_by_more_than_a_thirtieth_unless_the_target_leaves_too_few_faces():
    mesh, tips = spiky_ball(2.0, 0.15)
    simple = simplify(mesh, 300)
    assert len(simple.faces) == 300
    assert vertex_errors(simple, mesh)[tips].max() < RADIUS * 2 / 30  # the planes of a tip all run along it
    assert metro(mesh, simple)["mean"] < 0.01
    assert len(simplify(mesh, 20).faces) == 20


@pytest.mark.parametrize(
    ("count", "asked", "shown"), [(50, 10, 10), pytest.param(22_000, 10**6, 21_845, marks=pytest.mark.slow)]
)
def test_parts_too_many_to_simplify_are_shown_by_their_largest_faces(count, asked, shown):
    """And by few enough for the page, whose ids of vertices have 16 bits."""
    sizes = np.arange(1, count + 1)
    vertices = sizes[:, None, None] * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]) + [0, 0, 1]
    leaves = Mesh(vertices.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3))
    small, _ = shown_mesh(leaves, asked)
    assert len(small.faces) == shown and len(small.vertices) < 2**16
    assert np.sort(small.face_areas)[0] == (count - shown + 1) ** 2 / 2
