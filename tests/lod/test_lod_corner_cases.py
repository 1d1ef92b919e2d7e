"""Input that simplifiers stumble over: degenerate faces, flips, locked borders, seams, sparse ids, dead ends.

The kinds of input are those of the tests of meshoptimizer's own simplifier (MIT licence); the meshes are our own.
"""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import InfeasibleTarget, simplify
from haptic_glance.lod.topology import faults, topology
from haptic_glance.mesh.mesh import Mesh

BALL = trimesh.creation.icosphere(3, radius=0.5)


def sheet(side=16, height=0.0):
    """An open sheet over the unit square, wavy by `height`; the normals point up."""
    x, y = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side), indexing="ij")
    a = np.arange(side * side).reshape(side, side)[:-1, :-1].ravel()
    faces = np.r_[np.c_[a, a + side, a + 1], np.c_[a + 1, a + side, a + side + 1]]
    return Mesh(np.c_[x.ravel(), y.ravel(), height * np.sin(7 * x.ravel()) * np.cos(5 * y.ravel())], faces)


def places(mesh, x):
    """The set of places of the vertices at this x."""
    return {tuple(place) for place in mesh.vertices[mesh.vertices[:, 0] == x].tolist()}


def normals_up(mesh):
    return mesh.face_crosses[:, 2] / np.linalg.norm(mesh.face_crosses, axis=1)


DEGENERATE = {
    "one vertex three times": lambda ids, _: [[ids[0]] * 3],
    "one vertex twice": lambda ids, _: [[ids[0], ids[0], ids[1]], [ids[1], ids[2], ids[1]]],
    "three vertices at one place": lambda _, n: [[n, n + 1, n + 2]],
    "three vertices on a line": lambda _, n: [[n, n + 3, n + 4]],
}


@pytest.mark.parametrize("name", DEGENERATE)
def test_faces_without_area_do_no_harm(name):
    lone = [[2.0, 0, 0], [2, 0, 0], [2, 0, 0], [2.1, 0, 0], [2.2, 0, 0]]
    bad = DEGENERATE[name](BALL.faces[0], len(BALL.vertices))
    mesh = Mesh(np.r_[BALL.vertices, lone], np.r_[BALL.faces, bad])
    found = simplify(mesh, 400)
    assert len(found.faces) <= 400 and np.isfinite(found.vertices).all()
    assert not faults(found).added(faults(mesh))
    on_ball = np.linalg.norm(found.vertices, axis=1)
    assert np.abs(on_ball[on_ball < 1] - 0.5).max() < 0.03


def test_slivers_within_the_surface_do_no_harm():
    mesh = sheet()
    row = (np.arange(len(mesh.vertices)) // 16) == 7
    thin = Mesh(mesh.vertices + np.c_[row * (1 / 15 - 1e-9), np.zeros((len(row), 2))], mesh.faces)  # next to row 8
    found = simplify(thin, 150)
    assert normals_up(found).min() > 0.999 and found.face_areas.sum() == pytest.approx(1)


@pytest.mark.parametrize("faces", [400, 200, 90])
def test_no_face_of_a_flat_sheet_turns_over(faces):
    # A comb: all collapses are free of cost, and next to its inner corners many turn faces over.
    mesh = sheet(24)
    x, y = mesh.vertices[mesh.faces].mean(axis=1)[:, :2].T
    comb = Mesh(mesh.vertices, mesh.faces[(y < 0.4) | (x * 23 % 6 < 3)])
    try:
        found = simplify(comb, faces)
    except InfeasibleTarget as error:
        found = simplify(comb, error.smallest)
    assert (normals_up(found) > 0.999).all()
    assert found.face_areas.sum() == pytest.approx(comb.face_areas.sum())


def test_tiles_that_share_a_border_still_fit_together():
    whole = sheet(17, 0.05)
    left = whole.vertices[whole.faces].mean(axis=1)[:, 0] < 0.5
    one, two = (simplify(Mesh(whole.vertices, whole.faces[side]), 150) for side in (left, ~left))
    border = places(whole, 0.5)
    assert len(border) == 17 and places(one, 0.5) == places(two, 0.5) == border


def test_a_patch_of_reversed_faces_stays_whole():
    # Where two neighbours wind against each other the surface has no side: the edge stays as a border does.
    mesh = sheet(20)
    patch = (np.abs(mesh.vertices[mesh.faces].mean(axis=1)[:, :2] - 0.5) < 0.2).all(axis=1)
    faces = np.where(patch[:, None], mesh.faces[:, ::-1], mesh.faces)
    found = simplify(Mesh(mesh.vertices, faces), 400)
    down = normals_up(found) < 0
    assert found.face_areas[down].sum() == pytest.approx(mesh.face_areas[patch].sum())
    assert found.face_areas.sum() == pytest.approx(1) and len(found.faces) <= 400
    rim = np.unique(mesh.faces[patch])[np.isin(np.unique(mesh.faces[patch]), mesh.faces[~patch])]
    assert {tuple(place) for place in mesh.vertices[rim]} <= {tuple(place) for place in found.vertices}


def test_a_vertex_kept_on_one_side_of_a_seam_is_kept_on_both():
    mesh = sheet(17)
    right = mesh.vertices[mesh.faces].mean(axis=1)[:, 0] > 0.5
    n = len(mesh.vertices)
    cut = Mesh(np.r_[mesh.vertices, mesh.vertices], np.where(right[:, None], mesh.faces + n, mesh.faces))
    on_seam = 8 * 17 + 8
    for kept in (on_seam, on_seam + n):
        found = simplify(cut, 260, [kept], 0)
        assert (found.vertices == mesh.vertices[on_seam]).all(axis=1).sum() == 2


def test_no_crack_opens_along_a_seam():
    # Two copies of each vertex of the seam, as files with texture coordinates have them.
    ball = Mesh(BALL.vertices, BALL.faces)
    right = ball.vertices[ball.faces].mean(axis=1)[:, 0] > 0
    copies = np.where(right[:, None], ball.faces + len(ball.vertices), ball.faces)
    cut = Mesh(np.r_[ball.vertices, ball.vertices], copies)
    found = simplify(cut, 700)
    edges, counts = found.edge_counts
    rim = {tuple(sorted(map(tuple, found.vertices[edge].tolist()))) for edge in edges[counts == 1]}
    assert len(found.faces) <= 700
    assert 2 * len(rim) == (counts == 1).sum() == topology(cut.faces).boundary_edges  # each edge on both sides


def test_faces_that_use_few_of_many_vertices_come_out_as_without_the_others():
    ids = np.sort(np.random.default_rng(0).choice(50_000, len(BALL.vertices), replace=False))
    vertices = np.random.default_rng(1).normal(scale=1e3, size=(50_000, 3))
    vertices[ids] = BALL.vertices
    sparse = simplify(Mesh(vertices, ids[BALL.faces]), 300, [ids[5]])
    dense = simplify(Mesh(BALL.vertices, BALL.faces), 300, [5])
    assert sparse.vertices.tobytes() == dense.vertices.tobytes() and np.array_equal(sparse.faces, dense.faces)


@pytest.mark.parametrize("solid", [trimesh.creation.box, trimesh.creation.icosahedron])
def test_a_target_that_no_solid_has_ends_at_a_solid(solid):
    mesh = Mesh(*(getattr(solid().subdivide().subdivide(), name) for name in ("vertices", "faces")))
    with pytest.raises(InfeasibleTarget) as caught:
        simplify(mesh, 3)
    assert topology(simplify(mesh, caught.value.smallest).faces) == topology(mesh.faces)
    assert caught.value.smallest == 4
