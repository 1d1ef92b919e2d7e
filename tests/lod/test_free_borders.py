"""Borders that are simplified, too: shape and loops stay, and nothing of the hidden faces comes out."""

from dataclasses import replace

import numpy as np
import pytest

from haptic_glance.lod import InfeasibleTarget, metro, simplify
from haptic_glance.lod.feasibility import frozen_faces
from haptic_glance.lod.task import SimplificationTask
from haptic_glance.lod.topology import NONE, faults, topology
from haptic_glance.mesh.mesh import Mesh, Texture

from .conftest import sheet


def corners_of(mesh):
    return {tuple(np.round(vertex[:2], 3)) for vertex in mesh.vertices}


def test_a_flat_square_needs_but_a_few_faces_and_keeps_its_corners():
    simple = simplify(sheet(39), 8, free_borders=True)
    assert len(simple.faces) <= 8 and simple.face_areas.sum() == pytest.approx(1.0, abs=1e-3)
    assert {(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)} <= corners_of(simple)
    with pytest.raises(ValueError, match="infeasible"):
        simplify(sheet(39), 8)


def test_a_wavy_sheet_has_a_smaller_error_than_with_its_border_frozen():
    mesh = sheet(39, height=0.1)
    free, frozen = (metro(mesh, simplify(mesh, 450, free_borders=flag), seed=1)["mean"] for flag in (True, False))
    assert free < 0.9 * frozen


@pytest.mark.parametrize("faces", [500, 30])
def test_loops_and_pieces_stay_and_no_fault_is_new(faces):
    whole = sheet(39, height=0.1)
    hole = (np.abs(whole.vertices[whole.faces].mean(axis=1)[:, :2] - 0.5) < 0.2).all(axis=1)
    mesh = Mesh(whole.vertices, whole.faces[~hole])
    simple = simplify(mesh, faces, free_borders=True)
    before, after = topology(mesh.faces), topology(simple.faces)
    assert len(simple.faces) <= faces and np.isfinite(simple.vertices).all() and faults(simple) == NONE
    assert (after.boundary_loops, after.components, after.genus) == (before.boundary_loops, before.components, 0)
    assert after.boundary_loops == 2 and len(np.unique(simple.faces)) == len(simple.vertices)


def test_of_a_closed_mesh_not_one_bit_changes(ball):
    frozen, free = (simplify(ball, 200, free_borders=flag) for flag in (False, True))
    assert (frozen.vertices == free.vertices).all() and (frozen.faces == free.faces).all()


def test_frozen_faces_at_the_border_stay_bit_for_bit():
    mesh = sheet(39, height=0.1)
    simple = simplify(mesh, 300, keep=[0, 820], rings=2, free_borders=True)
    kept = {bytes(vertex) for vertex in mesh.vertices[np.unique(mesh.faces[frozen_faces(mesh, [0, 820], 2)])]}
    assert kept <= {bytes(vertex) for vertex in simple.vertices}


def test_only_the_vertices_named_may_move():
    mesh = sheet(39, height=0.1)
    left = mesh.vertices[:, 0] < 1e-9
    simple = simplify(mesh, 300, free_borders=~left)
    assert {bytes(vertex) for vertex in mesh.vertices[left]} <= {bytes(vertex) for vertex in simple.vertices}
    right = [int((np.abs(surface.vertices[:, 0] - 1) < 2e-3).sum()) for surface in (mesh, simple)]
    assert right[1] < right[0] / 2


def test_borders_between_materials_stay_where_the_boundary_is_free():
    mesh = sheet(39, height=0.1)
    image = np.full((2, 2, 4), 200, np.uint8)
    upper = (mesh.vertices[mesh.faces][:, :, 1].mean(axis=1) > 0.5).astype(np.int64)
    texture = Texture(np.zeros((len(mesh.faces), 3, 2)), upper, (image, 255 - image))
    painted = Mesh(mesh.vertices, mesh.faces, None, texture)
    nothing, values = np.zeros(0, dtype=np.int64), np.ones(len(mesh.vertices))
    task = SimplificationTask(painted, values, nothing, nothing, None, "fast", False, {}, True)
    simple = task.simplified(600)
    cut, ids = task.cut
    border = np.flatnonzero(np.bincount(ids) > 1)
    assert len(border) and {bytes(vertex) for vertex in task.mesh.vertices[border]} <= {
        bytes(vertex) for vertex in simple.vertices
    }
    assert topology(simple.faces).boundary_edges < topology(mesh.faces).boundary_edges / 2


@pytest.mark.parametrize("seed", range(6))
def test_the_count_that_a_refusal_offers_is_feasible(seed):
    mesh = sheet(12, height=0.1)
    holes = np.random.default_rng(seed).random(len(mesh.faces)) < 0.1
    mesh = replace(mesh, faces=mesh.faces[~holes])
    with pytest.raises(InfeasibleTarget) as refusal:
        simplify(mesh, 4, free_borders=True)
    assert len(simplify(mesh, refusal.value.smallest, free_borders=True).faces) <= refusal.value.smallest < 280


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"backend": "pymeshlab"}, "leave one out"),
        ({"attributes": {"normals": 0.1}}, "leave one out"),
        ({"free_borders": np.ones(3, dtype=bool)}, "one per vertex"),
    ],
)
def test_what_cannot_be_is_refused_with_a_remedy(changes, words):
    with pytest.raises(ValueError, match=words):
        simplify(sheet(39), 100, **{"free_borders": True} | changes)
