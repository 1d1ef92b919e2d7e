"""Large meshes are thinned out block by block: the blocks join again as they were, and the result is as good."""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import blocks, metro, simplify, vertex_errors
from haptic_glance.lod.fast import collapse
from haptic_glance.lod.topology import faults, topology
from haptic_glance.mesh.mesh import Mesh
from tests.lod.test_attribute_weights import plane


@pytest.fixture
def small(monkeypatch):
    """Blocks of some hundred faces."""
    monkeypatch.setattr(blocks, "FROM", 2000)
    monkeypatch.setattr(blocks, "BLOCK", 800)


def torus():
    made = trimesh.creation.torus(1, 0.35, 128, 64)
    ripples = 1 + 0.02 * np.sin(9 * made.vertices[:, [1, 2, 0]])
    return Mesh(ripples * made.vertices, made.faces)


def nothing(mesh):
    return np.zeros(len(mesh.faces), bool)


def test_every_face_is_in_one_block(small):
    parts = blocks.split(torus())
    assert len(parts) > 10 and max(map(len, parts)) < 4000
    assert np.array_equal(np.sort(np.concatenate(parts)), np.arange(len(torus().faces)))


def test_blocks_join_again_without_a_crack(small):
    mesh = torus()
    found, _, _ = blocks.thinned(mesh, 0.1, nothing(mesh), None)
    assert len(found.faces) < 0.7 * len(mesh.faces) and found.watertight
    assert topology(found.faces) == topology(mesh.faces) and faults(found) == faults(mesh)


def test_what_nothing_is_taken_from_comes_back_itself(small):
    mesh = torus()
    found, frozen, weights = blocks.thinned(mesh, 1.0, nothing(mesh), np.arange(len(mesh.vertices)) + 1.0)
    ids = (weights - 1).astype(int)
    assert found.vertices == pytest.approx(mesh.vertices[ids], abs=1e-12) and not frozen.any()
    assert sorted(ids[found.faces].tolist()) == sorted(mesh.faces.tolist())


def test_the_result_is_as_good_as_of_the_whole(small):
    mesh = torus()
    whole, found = collapse(mesh, 500, nothing(mesh)), blocks.collapse(mesh, 500, nothing(mesh))
    assert len(found.faces) == len(whole.faces) == 500 and faults(found) == faults(mesh)
    assert metro(mesh, found)["mean"] < 1.15 * metro(mesh, whole)["mean"]


def test_frozen_faces_and_the_boundary_stay(small):
    mesh = plane(60, height=0.05)
    frozen = nothing(mesh)
    frozen[1000:1040] = True
    found, still, _ = blocks.thinned(mesh, 0.1, frozen, None)
    here, there = found.vertices[found.faces[still]], mesh.vertices[mesh.faces[frozen]]
    assert sorted(map(bytes, here)) == sorted(map(bytes, there))
    final = simplify(mesh, 900, [1800], 2)
    rim = (np.abs(mesh.vertices[:, :2] - 0.5) == 0.5).any(axis=1)
    assert set(map(bytes, mesh.vertices[rim | mesh.rings([1800], 2)])) <= set(map(bytes, final.vertices))


def test_copies_at_one_place_stay_apart(small):
    one = plane(40)
    two = Mesh(np.r_[one.vertices, one.vertices], np.r_[one.faces, one.faces + len(one.vertices)])
    found, _, _ = blocks.thinned(two, 0.1, nothing(two), None)
    assert topology(found.faces) == topology(two.faces) and topology(found.faces).components == 2


def test_the_number_of_cores_changes_nothing(small, monkeypatch):
    mesh, found = torus(), []
    for cores in (1, 3):
        monkeypatch.setattr(blocks, "cpu_count", lambda cores=cores: cores)
        found.append(simplify(mesh, 500, weights=np.linspace(0, 1, len(mesh.vertices))))
    assert found[0].vertices.tobytes() == found[1].vertices.tobytes() and np.array_equal(found[0].faces, found[1].faces)


def test_weights_reach_the_blocks(small):
    mesh = torus()
    left = mesh.vertices[:, 0] < 0
    found, _, _ = blocks.thinned(mesh, 0.1, nothing(mesh), np.where(left, 31.0, 1.0))
    off = vertex_errors(found, mesh)
    assert off[left].mean() < 0.8 * off[~left].mean()


def test_a_thinned_mesh_with_faults_is_not_used(small, monkeypatch):
    mesh = torus()
    monkeypatch.setattr(blocks, "_joined", lambda *_: (Mesh(mesh.vertices, mesh.faces[:, ::-1]), nothing(mesh), None))
    assert blocks.thinned(mesh, 0.1, nothing(mesh), None)[0] is mesh


def test_small_meshes_and_mild_targets_are_left_whole(monkeypatch):
    monkeypatch.setattr(blocks, "thinned", None)
    simplify(torus(), 500)
    monkeypatch.setattr(blocks, "FROM", 2000)
    simplify(torus(), 600)
