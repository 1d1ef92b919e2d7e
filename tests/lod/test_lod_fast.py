"""The compiled backend: what once went wrong in it."""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import InfeasibleTarget, SimplifyError, fast, frozen_faces, metro, simplify
from haptic_glance.lod.fast import collapse
from haptic_glance.lod.kernels.collapse import decimate
from haptic_glance.lod.kernels.mesh import before
from haptic_glance.lod.kernels.refit import refit
from haptic_glance.lod.topology import faults, topology
from haptic_glance.mesh.mesh import Mesh


def subdivided_box(times):
    box = trimesh.creation.box(extents=(0.6, 0.5, 0.4))
    for _ in range(times):
        box = box.subdivide()
    return Mesh(box.vertices, box.faces)


def bumpy(seed=0):
    ball = trimesh.creation.icosphere(subdivisions=4)
    radius = 0.4 + 0.01 * np.random.default_rng(seed).normal(size=len(ball.vertices))
    return Mesh(ball.vertices * radius[:, None], ball.faces)


def nothing(mesh):
    return np.zeros(len(mesh.faces), dtype=bool)


def rows(mesh):
    return {face.tobytes() for face in np.ascontiguousarray(mesh.vertices[mesh.faces])}


def test_islands_of_frozen_faces_close_together_all_survive():
    # An edge that waits while one end is free must not be collapsed once both ends are locked.
    mesh = bumpy()
    keep = np.random.default_rng(1).choice(len(mesh.vertices), 40, replace=False)
    frozen = frozen_faces(mesh, keep, 2)
    found = collapse(mesh, int(frozen.sum()) + 700, frozen)
    assert rows(Mesh(mesh.vertices, mesh.faces[frozen])) <= {np.roll(f.reshape(3, 3), k, axis=0).tobytes()
        for f in map(np.frombuffer, rows(found)) for k in range(3)}  # fmt: skip
    assert topology(found.faces) == topology(mesh.faces)


def test_the_fit_leaves_flat_faces_and_edges_of_a_box_where_they_are():
    mesh = subdivided_box(4)
    for faces in (800, 200, 60):
        assert metro(mesh, collapse(mesh, faces, nothing(mesh)), 2000)["max"] < 1e-5


def test_a_plate_folded_onto_itself_can_be_simplified():
    # Pairs of faces that are folded already, as where a lid lies on a pot, must not stop the collapses around them.
    mesh = subdivided_box(4)
    flat = Mesh(mesh.vertices * [1, 1, 1e-9], mesh.faces)
    found = collapse(flat, 600, nothing(flat))
    assert metro(flat, found, 2000)["mean"] < 1e-4
    assert faults(found).folded <= faults(flat).folded


def ball(subdivisions=4):
    made = trimesh.creation.icosphere(subdivisions=subdivisions, radius=0.5)
    return Mesh(made.vertices, made.faces)


def test_the_fit_brings_the_surface_nearer_than_qslim():
    mesh = ball()
    fitted = collapse(mesh, 200, nothing(mesh))
    left = simplify(mesh, 200, backend="qslim")
    assert metro(mesh, fitted)["mean"] < 0.8 * metro(mesh, left)["mean"]


def test_the_fit_moves_free_vertices_and_leaves_locked_ones():
    mesh = bumpy()
    surface = fast.half_edge_mesh(mesh, frozen_faces(mesh, [7, 900], 2), None)[0]
    points, corner = surface.position.copy(), surface.corner.copy()
    decimate(surface, None, 900, *fast.ATTEMPTS[0], fast.FOLD)
    before_fit = surface.position.copy()
    refit(surface, points, corner, np.ones(len(points)), 4000, fast.FOLD)
    moved = (surface.position != before_fit).any(axis=1)
    assert not moved[surface.locked].any()
    assert moved[~surface.locked].sum() > 100


def wavy_sheet(side=30):
    """An open sheet, wavy across, with a hole: two boundary loops."""
    x, y = np.meshgrid(np.linspace(0, 1, side), np.linspace(0, 1, side), indexing="ij")
    a = np.arange(side * side).reshape(side, side)[:-1, :-1].ravel()
    faces = np.r_[np.c_[a, a + side, a + 1], np.c_[a + 1, a + side, a + side + 1]]
    vertices = np.c_[x.ravel(), y.ravel(), 0.1 * np.sin(9 * x * y).ravel()]
    away = np.linalg.norm(vertices[faces].mean(axis=1)[:, :2] - [0.4, 0.6], axis=1) > 0.15
    return Mesh(vertices, faces[away])


def fan(surface, vertex):
    """The half-edges that leave a vertex, found from the one that is named as its first."""
    found = [int(surface.start[vertex])]
    while (h := int(surface.opposite[before.py_func(found[-1])])) >= 0 and h != found[0]:
        found.append(h)
    return found


@pytest.mark.parametrize("make", [wavy_sheet, bumpy])
def test_the_whole_fan_of_a_vertex_is_found_after_any_collapses(make):
    # On the boundary it is found from its first half-edge alone, on which all checks rest: a lost face is not checked.
    for faces in (1200, 700, 300):
        surface = fast.half_edge_mesh(make(), nothing(make()), None)[0]
        decimate(surface, None, faces, *fast.ATTEMPTS[0], fast.FOLD)
        alive = np.flatnonzero(surface.corner >= 0)
        for vertex in np.unique(surface.corner[alive]):
            assert sorted(fan(surface, vertex)) == alive[surface.corner[alive] == vertex].tolist()


def test_a_tetrahedron_never_becomes_two_faces_back_to_back():
    tetrahedron = Mesh(
        [[0, 0, 0], [1, 0, 0], [0.5, 0.9, 0], [0.5, 0.3, 0.8]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    )
    surface = fast.half_edge_mesh(tetrahedron, nothing(tetrahedron), None)[0]
    assert decimate(surface, None, 2, *fast.LAST, fast.NO_FOLD) == 4  # where folds count, they hold it up as well


def attempts(monkeypatch, *results):
    """Has the backend's attempts give these, the last one again and again; returns the list of the calls."""
    calls = []

    def attempt(*arguments):
        calls.append(arguments)
        found = results[min(len(calls), len(results)) - 1]
        return found, len(found.faces)

    monkeypatch.setattr(fast, "_attempt", attempt)
    return calls


def folded(mesh):
    return Mesh(mesh.vertices, np.r_[mesh.faces, mesh.faces[:1, ::-1]])


def test_a_faulty_attempt_is_followed_by_others(monkeypatch):
    calls = attempts(monkeypatch, folded(ball(2)), folded(ball(2)), ball(2))
    assert faults(collapse(ball(3), 400, nothing(ball(3)))) == faults(ball(2))
    assert len(calls) == 3


def test_faults_of_all_attempts_are_named_and_nothing_is_returned(monkeypatch):
    attempts(monkeypatch, folded(ball(2)))
    with pytest.raises(SimplifyError, match="400 faces leave .* new .*: ask for more faces"):
        collapse(ball(3), 400, nothing(ball(3)))


def test_a_count_that_was_had_with_faults_alone_is_not_promised(monkeypatch):
    attempts(monkeypatch, folded(ball(1)), folded(ball(2)), ball(2), ball(3))
    with pytest.raises(InfeasibleTarget) as caught:
        collapse(ball(3), 60, nothing(ball(3)))
    assert caught.value.smallest == 320


def test_equal_meshes_give_equal_bytes():
    first, second = (collapse(bumpy(), 400, nothing(bumpy())) for _ in range(2))
    assert first.vertices.tobytes() == second.vertices.tobytes()
    assert first.faces.tobytes() == second.faces.tobytes()
