"""Simplification keeps what it must, on shapes whose topology is known."""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import SimplifyError, frozen_faces, qem, quadric_weights, simplify
from haptic_glance.lod.topology import faults, topology
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import together

from .conftest import ball, sheet, torus


def as_triangles(mesh, faces=slice(None)):
    """The set of faces as coordinates, first corner the smallest, so that windings are compared too."""
    triangles = set()
    for triangle in mesh.vertices[mesh.faces[faces]].tolist():
        corners = [tuple(corner) for corner in triangle]
        turn = corners.index(min(corners))
        triangles.add(tuple(corners[turn:] + corners[:turn]))
    return triangles


@pytest.mark.parametrize("mesh", [ball(), torus(), sheet(39, height=0.1)], ids=["ball", "torus", "sheet"])
def test_boundary_components_and_genus_hold_and_no_fault_is_added(mesh):
    simple = simplify(mesh, 900, [5, 700])
    assert 898 <= len(simple.faces) <= 900
    assert topology(simple.faces) == topology(mesh.faces)
    assert not faults(simple).added(faults(mesh))
    assert np.isin(np.arange(len(simple.vertices)), simple.faces).all()


def test_unit_of_length_does_not_matter():
    mesh = ball(3)
    simple = simplify(mesh, 300)
    for unit in (2.0**-30, 2.0**30):
        assert np.array_equal(simplify(Mesh(mesh.vertices * unit, mesh.faces), 300).vertices, simple.vertices * unit)


def test_many_nonmanifold_vertices_do_not_hold_the_surface_up():
    inner = ball(3)
    pinched = []
    for vertex in range(642):  # no two joined by an edge: that would be an edge of four faces, not two pinches
        if not inner.adjacency[[vertex]][:, pinched].nnz:
            pinched.append(vertex)
    outer = Mesh(inner.vertices * 1.2, inner.faces)
    nested = together(inner, outer)
    pair = Mesh(
        nested.vertices, np.where(np.isin(nested.faces, np.add(pinched, 642)), nested.faces - 642, nested.faces)
    )
    simple = simplify(pair, 250)
    assert len(simple.faces) == 250
    assert topology(simple.faces) == topology(pair.faces)


def test_a_tiny_piece_and_a_thin_handle_survive_a_low_target():
    speck = Mesh(ball(2).vertices * 0.01 + [0.6, 0, 0], ball(2).faces)
    assert topology(simplify(together(ball(3), speck), 60).faces).components == 2
    thin = trimesh.creation.torus(0.4, 0.02, major_sections=48, minor_sections=12)
    assert topology(simplify(Mesh(thin.vertices, thin.faces), 60).faces).genus == 1


def test_a_result_with_new_faults_is_never_returned(monkeypatch):
    mesh = ball(3)
    folded = Mesh(mesh.vertices, np.r_[mesh.faces[:300], mesh.faces[:1, ::-1]])
    monkeypatch.setattr(qem, "decimated", lambda *_: folded)
    with pytest.raises(SimplifyError, match="new"):
        simplify(mesh, 400, backend="pymeshlab")


@pytest.mark.slow
def test_an_attempt_that_ruins_the_surface_is_no_way_out_of_a_fault(monkeypatch):
    mesh, small = ball(3), ball(2)
    folded = Mesh(small.vertices, np.r_[small.faces, small.faces[:1, ::-1]])
    for scale, sound in ((0.5, False), (1.0, True)):
        results = iter([folded] + [Mesh(small.vertices * scale, small.faces)] * 9)
        monkeypatch.setattr(qem, "decimated", lambda *_, results=results: next(results))
        if sound:
            assert len(qem.collapse(mesh, 400, np.zeros(1280, dtype=bool)).faces) == 320
        else:
            with pytest.raises(SimplifyError, match="far from"):
                qem.collapse(mesh, 400, np.zeros(1280, dtype=bool))


def test_frozen_faces_survive_bit_for_bit_where_rings_differ_and_a_vertex_may_be_left_out():
    mesh, keep = Mesh(ball().vertices + np.pi * 1e-3, ball().faces), [11, 900, 1500]
    simple = simplify(mesh, 1200, keep, np.array([3, 0, -1]), weights=np.linspace(0, 1, len(mesh.vertices)))
    held = as_triangles(simple)
    assert as_triangles(mesh, frozen_faces(mesh, [11], 3) | frozen_faces(mesh, [900], 0)) <= held
    for vertex, rings in ((900, 2), (1500, 0)):
        assert not as_triangles(mesh, frozen_faces(mesh, [vertex], rings)) <= held


def test_where_the_weight_is_high_more_faces_stay_and_the_surface_is_closer():
    mesh = ball()
    soft = simplify(mesh, 300, weights=(mesh.vertices[:, 2] > 0).astype(float))
    upper = (soft.vertices[soft.faces].mean(axis=1)[:, 2] > 0).mean()
    assert upper > 0.6  # half of them on plain QEM
    assert topology(soft.faces) == topology(mesh.faces)
    assert np.isin(np.arange(len(soft.vertices)), soft.faces).all()


def test_weights_are_not_stretched_to_their_own_range():
    mesh = ball()
    faint = simplify(mesh, 300, weights=np.where(mesh.vertices[:, 2] > 0, 1e-9, 0.0))
    assert (faint.vertices[faint.faces].mean(axis=1)[:, 2] > 0).mean() == pytest.approx(0.5, abs=0.05)


def test_quadric_weights_grow_with_saliency_from_one_within_what_every_backend_takes():
    weights = quadric_weights(np.array([0.0, 0.5, 1.0]))
    assert weights[0] == 1 and (np.diff(weights) > 0).all() and weights[2] <= qem.QUALITY_FACTOR
    assert quadric_weights(np.full(3, 0.7)) is None


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"faces": 0}, "1 or more"),
        ({"keep": [10**6]}, "outside"),
        ({"keep": [-1]}, "outside"),
        ({"keep": [0.5]}, "vertex ids"),
        ({"keep": [1], "rings": -1}, "rings"),
        ({"keep": [1, 2], "rings": [3]}, "one per kept vertex"),
        ({"keep": [1, 2], "rings": [3, -2]}, "-1"),
        ({"keep": [1, 2], "rings": [3.0, 1.0]}, "whole numbers"),
        ({"weights": [0.5]}, "one per vertex"),
        ({"weights": np.full(162, 1.5)}, "0..1"),
        ({"weights": np.r_[np.nan, np.zeros(161)]}, "NaN"),
        ({"backend": "nobody"}, "pymeshlab"),
        ({"mesh": Mesh(np.zeros((3, 3)), np.zeros((0, 3)))}, "0 faces"),
    ],
)
def test_bad_arguments_are_named(arguments, message):
    with pytest.raises(ValueError, match=message):
        simplify(**{"mesh": ball(2), "faces": 100} | arguments)
