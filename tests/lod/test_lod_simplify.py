"""Simplification keeps what it must, on shapes whose topology is known."""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import (
    InfeasibleTarget,
    SimplifyError,
    frozen_faces,
    metro,
    qem,
    quadric_weights,
    shrunk_rings,
    simplify,
    smallest_feasible,
)
from haptic_glance.lod.topology import Topology, faults, topology
from haptic_glance.mesh.mesh import Mesh


def sphere(subdivisions=4):
    ball = trimesh.creation.icosphere(subdivisions=subdivisions, radius=0.5)
    return Mesh(ball.vertices, ball.faces)


def torus():
    ring = trimesh.creation.torus(0.35, 0.15, major_sections=48, minor_sections=24)
    return Mesh(ring.vertices, ring.faces)


def hill(side=40):
    """An open sheet with a bump: one loop of 4 (side - 1) boundary edges."""
    x, y = np.meshgrid(np.linspace(-0.4, 0.4, side), np.linspace(-0.4, 0.4, side), indexing="ij")
    a = np.arange(side * side).reshape(side, side)[:-1, :-1].ravel()
    z = 0.2 * np.exp(-(x**2 + y**2) / 0.02)
    faces = np.r_[np.c_[a, a + side, a + 1], np.c_[a + 1, a + side, a + side + 1]]
    return Mesh(np.c_[x.ravel(), y.ravel(), z.ravel()], faces)


def as_triangles(mesh, faces=slice(None)):
    """The set of faces as coordinates, first corner the smallest, so that windings are compared too."""
    found = set()
    for triangle in mesh.vertices[mesh.faces[faces]].tolist():
        corners = [tuple(corner) for corner in triangle]
        turn = corners.index(min(corners))
        found.add(tuple(corners[turn:] + corners[:turn]))
    return found


def together(*meshes):
    offsets = np.cumsum([0] + [len(m.vertices) for m in meshes[:-1]])
    faces = [m.faces + k for m, k in zip(meshes, offsets, strict=True)]
    return Mesh(np.concatenate([m.vertices for m in meshes]), np.concatenate(faces))


@pytest.mark.parametrize("make", [sphere, torus, hill])
@pytest.mark.parametrize("keep", [None, [5, 700]])
def test_boundary_components_and_genus_hold_and_no_fault_is_added(make, keep):
    mesh = make()
    simple = simplify(mesh, 900, keep)
    assert 898 <= len(simple.faces) <= 900
    assert topology(simple.faces) == topology(mesh.faces)
    assert not faults(simple).added(faults(mesh))
    assert np.isin(np.arange(len(simple.vertices)), simple.faces).all()


@pytest.mark.parametrize("rings", [0, 1, 3])
def test_frozen_faces_survive_bit_for_bit(rings):
    mesh = Mesh(sphere().vertices + np.pi * 1e-3, sphere().faces)
    keep = [11, 1500]
    frozen = frozen_faces(mesh, keep, rings)
    simple = simplify(mesh, 1200, keep, rings)
    assert as_triangles(mesh, frozen) <= as_triangles(simple)
    assert not as_triangles(mesh, frozen) <= as_triangles(simplify(mesh, 1200))


def test_open_boundary_survives_bit_for_bit():
    mesh = hill()
    edges, counts = mesh.edge_counts
    boundary = {tuple(point) for point in mesh.vertices[np.unique(edges[counts == 1])].tolist()}
    assert boundary <= {tuple(point) for point in simplify(mesh, 900).vertices.tolist()}


def test_separate_components_stay_separate():
    mesh = together(sphere(3), Mesh(sphere(3).vertices + [1.2, 0, 0], sphere(3).faces))
    assert topology(simplify(mesh, 300).faces).components == 2


def test_same_call_gives_same_bytes_whatever_was_called_before():
    mesh = sphere(3)
    first = simplify(mesh, 400)
    simplify(mesh, 600, keep=[3])
    again = simplify(mesh, 400)
    assert first.vertices.tobytes() == again.vertices.tobytes()
    assert first.faces.tobytes() == again.faces.tobytes()


def test_unit_of_length_does_not_matter():
    mesh = sphere(3)
    simple = simplify(mesh, 300)
    for unit in (2.0**-30, 2.0**30):
        assert np.array_equal(simplify(Mesh(mesh.vertices * unit, mesh.faces), 300).vertices, simple.vertices * unit)


def test_enough_faces_give_the_mesh_itself():
    mesh = sphere(2)
    assert simplify(mesh, len(mesh.faces)) is mesh
    assert simplify(mesh, 10**6, keep=[1]) is mesh


def test_colours_follow_the_surface():
    mesh = sphere(3)
    colors = np.where(mesh.vertices[:, 2:] > 0, [[200, 0, 0]], [[0, 0, 200]]).astype(np.uint8)
    simple = simplify(Mesh(mesh.vertices, mesh.faces, colors), 300)
    up = np.abs(simple.vertices[:, 2]) > 0.1
    assert ((simple.colors[:, 0] == 200) == (simple.vertices[:, 2] > 0))[up].all()


def test_flat_faces_of_a_box_cost_nothing_and_get_no_degenerate_face():
    box = trimesh.creation.box(extents=(0.6, 0.5, 0.4))
    for _ in range(4):
        box = box.subdivide()
    mesh = Mesh(box.vertices, box.faces)
    simple = simplify(mesh, 200)
    assert metro(mesh, simple, 2000)["max"] < 1e-4
    assert faults(simple).degenerate == 0


def test_surfaces_that_touch_in_a_point_are_simplified_apart():
    one = sphere(3)
    top = int(np.argmax(one.vertices[:, 2]))
    other = Mesh(one.vertices * [1, 1, -1] + [0, 0, 2 * one.vertices[top, 2]], one.faces[:, ::-1])
    pair = together(one, other)
    pair = Mesh(pair.vertices, np.where(pair.faces == top + len(one.vertices), top, pair.faces))
    simple = simplify(pair, 300)
    assert topology(simple.faces) == Topology(0, 0, 2, 2, genus=0)


def test_many_nonmanifold_vertices_do_not_hold_the_surface_up():
    inner = sphere(3)
    pinched = []
    for vertex in range(642):  # no two joined by an edge: that would be an edge of four faces, not two pinches
        if not inner.adjacency[[vertex]][:, pinched].nnz:
            pinched.append(vertex)
    outer = Mesh(inner.vertices * 1.2, inner.faces)
    both = together(inner, outer)
    pair = Mesh(both.vertices, np.where(np.isin(both.faces, np.add(pinched, 642)), both.faces - 642, both.faces))
    simple = simplify(pair, 250)
    assert len(simple.faces) == 250
    assert topology(simple.faces) == topology(pair.faces)


def test_a_tiny_piece_and_a_thin_handle_survive_a_low_target():
    speck = Mesh(sphere(2).vertices * 0.01 + [0.6, 0, 0], sphere(2).faces)
    assert topology(simplify(together(sphere(3), speck), 60).faces).components == 2
    thin = trimesh.creation.torus(0.4, 0.02, major_sections=48, minor_sections=12)
    assert topology(simplify(Mesh(thin.vertices, thin.faces), 60).faces).genus == 1


def test_infeasible_target_names_the_smallest_count_and_that_count_works():
    mesh, keep = sphere(), [11, 900, 1500, 2200]
    with pytest.raises(InfeasibleTarget) as caught:
        simplify(mesh, 250, keep)
    assert caught.value.smallest == smallest_feasible(mesh, keep)
    simple = simplify(mesh, caught.value.smallest, keep)
    assert len(simple.faces) <= caught.value.smallest
    assert metro(mesh, simple, 2000)["mean"] < 0.01


def test_a_result_with_new_faults_is_never_returned(monkeypatch):
    mesh = sphere(3)
    folded = Mesh(mesh.vertices, np.r_[mesh.faces[:300], mesh.faces[:1, ::-1]])
    monkeypatch.setattr(qem, "decimated", lambda *_: folded)
    with pytest.raises(SimplifyError, match="new"):
        simplify(mesh, 400, backend="pymeshlab")


@pytest.mark.slow
def test_an_attempt_that_ruins_the_surface_is_no_way_out_of_a_fault(monkeypatch):
    mesh, small = sphere(3), sphere(2)
    folded = Mesh(small.vertices, np.r_[small.faces, small.faces[:1, ::-1]])
    for scale, sound in ((0.5, False), (1.0, True)):
        results = iter([folded] + [Mesh(small.vertices * scale, small.faces)] * 9)
        monkeypatch.setattr(qem, "decimated", lambda *_, results=results: next(results))
        if sound:
            assert len(qem.collapse(mesh, 400, np.zeros(1280, dtype=bool)).faces) == 320
        else:
            with pytest.raises(SimplifyError, match="far from"):
                qem.collapse(mesh, 400, np.zeros(1280, dtype=bool))


def test_rings_may_differ_and_a_vertex_may_be_left_out():
    mesh, keep = sphere(), [11, 900, 1500]
    simple = simplify(mesh, 1200, keep, np.array([3, 1, -1]))
    held = as_triangles(simple)
    assert as_triangles(mesh, frozen_faces(mesh, [11], 3) | frozen_faces(mesh, [900], 1)) <= held
    for vertex, rings in ((900, 2), (1500, 0)):
        assert not as_triangles(mesh, frozen_faces(mesh, [vertex], rings)) <= held


def test_shrinking_reaches_what_was_infeasible_and_keeps_the_rings_it_says():
    mesh, keep = sphere(), [11, 900, 1500, 2200]
    simple = simplify(mesh, 250, keep, shrink=True)
    assert len(simple.faces) <= 250
    rings = shrunk_rings(mesh, 250, keep)
    assert as_triangles(mesh, frozen_faces(mesh, keep, rings)) <= as_triangles(simple)
    assert simplify(mesh, 250, keep, rings).vertices.tobytes() == simple.vertices.tobytes()


def test_shrinking_changes_nothing_where_the_target_is_feasible():
    mesh, keep = sphere(), [11, 900]
    assert np.array_equal(simplify(mesh, 900, keep, shrink=True).vertices, simplify(mesh, 900, keep).vertices)


def test_nothing_is_left_to_shrink_below_the_floor_of_the_mesh():
    with pytest.raises(InfeasibleTarget) as caught:
        simplify(torus(), 12, [5], shrink=True)
    assert caught.value.smallest == smallest_feasible(torus())


def test_equal_weights_are_plain_qem():
    mesh = sphere(3)
    plain = simplify(mesh, 300)
    for weight in (0.0, 0.4, 1.0):
        soft = simplify(mesh, 300, weights=np.full(len(mesh.vertices), weight))
        assert soft.vertices.tobytes() == plain.vertices.tobytes() and np.array_equal(soft.faces, plain.faces)


def test_where_the_weight_is_high_more_faces_stay_and_the_surface_is_closer():
    mesh = sphere()
    soft = simplify(mesh, 300, weights=(mesh.vertices[:, 2] > 0).astype(float))
    upper = (soft.vertices[soft.faces].mean(axis=1)[:, 2] > 0).mean()
    assert upper > 0.6  # half of them on plain QEM
    assert topology(soft.faces) == topology(mesh.faces)
    assert np.isin(np.arange(len(soft.vertices)), soft.faces).all()


def test_weights_are_not_stretched_to_their_own_range():
    mesh = sphere()
    faint = simplify(mesh, 300, weights=np.where(mesh.vertices[:, 2] > 0, 1e-9, 0.0))
    assert (faint.vertices[faint.faces].mean(axis=1)[:, 2] > 0).mean() == pytest.approx(0.5, abs=0.05)


def test_weights_and_kept_neighbourhoods_go_together():
    mesh = sphere()
    simple = simplify(mesh, 900, [11], weights=np.linspace(0, 1, len(mesh.vertices)))
    assert as_triangles(mesh, frozen_faces(mesh, [11])) <= as_triangles(simple)


def test_quadric_weights_grow_with_saliency_from_one_within_what_every_backend_takes():
    weights = quadric_weights(np.array([0.0, 0.5, 1.0]))
    assert weights[0] == 1 and (np.diff(weights) > 0).all() and weights[2] <= qem.QUALITY_FACTOR
    assert quadric_weights(np.full(3, 0.7)) is None


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"faces": 0}, "1 or more"),
        ({"faces": 100, "keep": [10**6]}, "outside"),
        ({"faces": 100, "keep": [-1]}, "outside"),
        ({"faces": 100, "keep": [0.5]}, "vertex ids"),
        ({"faces": 100, "keep": [1], "rings": -1}, "rings"),
        ({"faces": 100, "keep": [1, 2], "rings": [3]}, "one per kept vertex"),
        ({"faces": 100, "keep": [1, 2], "rings": [3, -2]}, "-1"),
        ({"faces": 100, "keep": [1, 2], "rings": [3.0, 1.0]}, "whole numbers"),
        ({"faces": 100, "weights": [0.5]}, "one per vertex"),
        ({"faces": 100, "weights": np.full(162, 1.5)}, "0..1"),
        ({"faces": 100, "weights": np.r_[np.nan, np.zeros(161)]}, "NaN"),
        ({"faces": 100, "backend": "nobody"}, "pymeshlab"),
    ],
)
def test_bad_arguments_are_named(arguments, message):
    with pytest.raises(ValueError, match=message):
        simplify(sphere(2), **arguments)


def test_empty_mesh_is_an_error():
    with pytest.raises(ValueError, match="0 faces"):
        simplify(Mesh(np.zeros((3, 3)), np.zeros((0, 3))), 10)
