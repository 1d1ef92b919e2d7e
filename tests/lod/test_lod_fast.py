"""The compiled backend: what once went wrong in it, and large meshes, thinned out block by block."""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import (
    InfeasibleTarget,
    SimplifyError,
    blocks,
    fast,
    frozen_faces,
    metro,
    simplify,
    vertex_errors,
)
from haptic_glance.lod.fast import collapse
from haptic_glance.lod.kernels.collapse import decimate
from haptic_glance.lod.kernels.mesh import before
from haptic_glance.lod.topology import faults, topology
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import together

from .conftest import ball, bumpy, nothing, sheet, subdivided_box


def rows(mesh):
    return {face.tobytes() for face in np.ascontiguousarray(mesh.vertices[mesh.faces])}


def test_islands_of_frozen_faces_close_together_all_survive():
    # An edge that waits while one end is free must not be collapsed once both ends are locked.
    mesh = bumpy()
    keep = np.random.default_rng(1).choice(len(mesh.vertices), 40, replace=False)
    frozen = frozen_faces(mesh, keep, 2)
    simple = collapse(mesh, int(frozen.sum()) + 700, frozen)
    assert rows(Mesh(mesh.vertices, mesh.faces[frozen])) <= {np.roll(f.reshape(3, 3), k, axis=0).tobytes()
        for f in map(np.frombuffer, rows(simple)) for k in range(3)}  # fmt: skip
    assert topology(simple.faces) == topology(mesh.faces)


def test_the_fit_leaves_flat_faces_and_edges_of_a_box_where_they_are():
    mesh = subdivided_box()
    for faces in (800, 60):
        simple = collapse(mesh, faces, nothing(mesh))
        assert metro(mesh, simple, 2000)["max"] < 1e-5 and faults(simple).degenerate == 0


def test_a_plate_folded_onto_itself_can_be_simplified():
    # Pairs of faces that are folded already, as where a lid lies on a pot, must not stop the collapses around them.
    mesh = subdivided_box(4)
    flat = Mesh(mesh.vertices * [1, 1, 1e-9], mesh.faces)
    simple = collapse(flat, 600, nothing(flat))
    assert metro(flat, simple, 2000)["mean"] < 1e-4
    assert faults(simple).folded <= faults(flat).folded


def fan(surface, vertex):
    """The half-edges that leave a vertex, found from the one that is named as its first."""
    leaving = [int(surface.start[vertex])]
    while (h := int(surface.opposite[before.py_func(leaving[-1])])) >= 0 and h != leaving[0]:
        leaving.append(h)
    return leaving


def test_the_whole_fan_of_a_vertex_is_found_after_any_collapses():
    # On the boundary it is found from its first half-edge alone, on which all checks rest: a lost face is not checked.
    whole = sheet(29, height=0.1)
    away = np.linalg.norm(whole.vertices[whole.faces].mean(axis=1)[:, :2] - [0.4, 0.6], axis=1) > 0.15
    mesh = Mesh(whole.vertices, whole.faces[away])
    for faces in (1200, 700, 300):
        surface = fast.half_edge_mesh(mesh, nothing(mesh), None)[0]
        decimate(surface, None, faces, *fast.ATTEMPTS[0], fast.FOLD)
        alive = np.flatnonzero(surface.corner >= 0)
        for vertex in np.unique(surface.corner[alive]):
            assert sorted(fan(surface, vertex)) == alive[surface.corner[alive] == vertex].tolist()


def attempts(monkeypatch, *results):
    """Has the backend's attempts give these, the last one again and again; returns the list of the calls."""
    calls = []

    def attempt(*arguments):
        calls.append(arguments)
        answer = results[min(len(calls), len(results)) - 1]
        return answer, len(answer.faces)

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


@pytest.fixture
def small(monkeypatch):
    """Blocks of some hundred faces."""
    monkeypatch.setattr(blocks, "FROM", 2000)
    monkeypatch.setattr(blocks, "BLOCK", 800)


def rippled():
    made = trimesh.creation.torus(1, 0.35, 128, 64)
    ripples = 1 + 0.02 * np.sin(9 * made.vertices[:, [1, 2, 0]])
    return Mesh(ripples * made.vertices, made.faces)


def test_blocks_join_again_without_a_crack(small):
    mesh = rippled()
    thin, _, _ = blocks.thinned(mesh, 0.1, nothing(mesh), None)
    assert len(thin.faces) < 0.7 * len(mesh.faces) and thin.watertight
    assert topology(thin.faces) == topology(mesh.faces) and faults(thin) == faults(mesh)


def test_what_nothing_is_taken_from_comes_back_itself(small):
    mesh = rippled()
    thin, frozen, weights = blocks.thinned(mesh, 1.0, nothing(mesh), np.arange(len(mesh.vertices)) + 1.0)
    ids = (weights - 1).astype(int)
    assert thin.vertices == pytest.approx(mesh.vertices[ids], abs=1e-12) and not frozen.any()
    assert sorted(ids[thin.faces].tolist()) == sorted(mesh.faces.tolist())


def test_the_result_is_as_good_as_of_the_whole(small):
    mesh = rippled()
    whole, joined = collapse(mesh, 500, nothing(mesh)), blocks.collapse(mesh, 500, nothing(mesh))
    assert len(joined.faces) == len(whole.faces) == 500 and faults(joined) == faults(mesh)
    assert metro(mesh, joined)["mean"] < 1.15 * metro(mesh, whole)["mean"]


def test_frozen_faces_and_the_boundary_stay(small):
    mesh = sheet(60, height=0.05)
    frozen = nothing(mesh)
    frozen[1000:1040] = True
    thin, still, _ = blocks.thinned(mesh, 0.1, frozen, None)
    corners, expected = thin.vertices[thin.faces[still]], mesh.vertices[mesh.faces[frozen]]
    assert sorted(map(bytes, corners)) == sorted(map(bytes, expected))
    final = simplify(mesh, 900, [1800], 2)
    rim = (np.abs(mesh.vertices[:, :2] - 0.5) == 0.5).any(axis=1)
    assert set(map(bytes, mesh.vertices[rim | mesh.rings([1800], 2)])) <= set(map(bytes, final.vertices))


def test_copies_at_one_place_stay_apart(small):
    layer = sheet(40)
    two = together(layer, layer)
    thin, _, _ = blocks.thinned(two, 0.1, nothing(two), None)
    assert topology(thin.faces) == topology(two.faces) and topology(thin.faces).components == 2


def test_the_number_of_cores_changes_nothing(small, monkeypatch):
    mesh, meshes = rippled(), []
    for cores in (1, 3):
        monkeypatch.setattr(blocks, "cpu_count", lambda cores=cores: cores)
        meshes.append(simplify(mesh, 500, weights=np.linspace(0, 1, len(mesh.vertices))))
    assert meshes[0].vertices.tobytes() == meshes[1].vertices.tobytes() and np.array_equal(
        meshes[0].faces, meshes[1].faces
    )


def test_weights_reach_the_blocks(small):
    mesh = rippled()
    left = mesh.vertices[:, 0] < 0
    thin, _, _ = blocks.thinned(mesh, 0.1, nothing(mesh), np.where(left, 31.0, 1.0))
    off = vertex_errors(thin, mesh)
    assert off[left].mean() < 0.8 * off[~left].mean()


def test_a_thinned_mesh_with_faults_is_not_used(small, monkeypatch):
    mesh = rippled()
    monkeypatch.setattr(blocks, "_joined", lambda *_: (Mesh(mesh.vertices, mesh.faces[:, ::-1]), nothing(mesh), None))
    assert blocks.thinned(mesh, 0.1, nothing(mesh), None)[0] is mesh


def test_small_meshes_and_mild_targets_are_left_whole(monkeypatch):
    monkeypatch.setattr(blocks, "thinned", None)
    simplify(rippled(), 500)
    monkeypatch.setattr(blocks, "FROM", 2000)
    simplify(rippled(), 600)
