"""Topology counts, the floor of the face count, and how neighbourhoods shrink to it, on shapes where they are known."""

import pickle

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import BACKENDS, InfeasibleTarget, frozen_faces, shrunk_rings, simplify, smallest_feasible
from haptic_glance.lod.topology import Topology, faults, split_nonmanifold_vertices, topology
from haptic_glance.mesh.mesh import Mesh

from .conftest import ball

LARGE = ball()
SPHERE = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
TORUS = trimesh.creation.torus(0.35, 0.15, major_sections=24, minor_sections=12)
TUBE = trimesh.creation.cylinder(0.2, 0.6, sections=16)
SHUFFLED = np.random.default_rng(0).permutation(TORUS.faces)
SHUFFLED[::3] = SHUFFLED[::3, ::-1]
BOW_TIE = np.array([[0, 1, 2], [0, 3, 4]])
PAGES = np.array([[0, 1, page] for page in range(2, 7)])  # an edge of several faces is a rim of each


@pytest.mark.parametrize(
    ("faces", "expected"),
    [
        pytest.param(SPHERE.faces, Topology(0, 0, 1, 1, genus=0), id="sphere"),
        pytest.param(TORUS.faces, Topology(0, 0, 1, 1, genus=1), id="torus"),
        pytest.param(SHUFFLED, Topology(0, 0, 1, 1, genus=1), id="torus in another order and winding"),
        pytest.param(PAGES[:1], Topology(3, 1, 1, 0, genus=0), id="triangle"),
        pytest.param(TUBE.faces[np.abs(TUBE.face_normals[:, 2]) < 0.5], Topology(32, 2, 1, 0, genus=0), id="tube"),
        pytest.param(BOW_TIE, Topology(6, 2, 2, 0, genus=0), id="bow tie"),
        pytest.param(PAGES[:3], Topology(9, 3, 3, 0, genus=0), id="book"),
    ],
)
def test_topology_of_known_surfaces(faces, expected):
    assert topology(faces) == expected


def test_a_vertex_of_two_fans_is_split():
    assert len(np.unique(split_nonmanifold_vertices(BOW_TIE))) == 6


def test_faults_count_degenerate_and_folded_faces():
    flat = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], [[0, 1, 2], [1, 3, 2]])
    assert (faults(flat).degenerate, faults(flat).folded) == (0, 0)
    folded = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.1, 0.1, 0]], [[0, 1, 2], [1, 3, 2]])
    assert faults(folded).folded == 1
    assert faults(Mesh(flat.vertices, [[0, 1, 2], [1, 2, 3]])).folded == 0  # inside out is no fold
    assert faults(Mesh(folded.vertices, [[0, 1, 2], [1, 2, 3]])).folded == 1
    needle = Mesh([[0, 0, 0], [1, 0, 0], [0.5, 1e-9, 0]], [[0, 1, 2]])
    assert faults(needle).degenerate == 1
    assert "1 new folded" in faults(folded).added(faults(flat))


def test_faults_count_the_half_edges_of_an_edge_of_many_faces():
    places = np.array([[0, 0, 0], [0, 0, 1], *([np.cos(at), np.sin(at), 0] for at in range(5))])
    three, four, five = (faults(Mesh(places, PAGES[:count])) for count in (3, 4, 5))
    assert three.non_manifold == 3 and "1 new half-edges" in five.added(four)


def test_frozen_faces_lie_wholly_within_the_rings():
    mesh = Mesh(SPHERE.vertices, SPHERE.faces)
    touching = (mesh.faces == 100).any(axis=1)
    assert (frozen_faces(mesh, [100], 0) == touching).all() and (frozen_faces(mesh, [100], 1) == touching).all()
    within = mesh.rings([100], 3)
    assert (frozen_faces(mesh, [100], 3) == within[mesh.faces].all(axis=1)).all()
    assert touching.sum() < frozen_faces(mesh, [100], 2).sum() < frozen_faces(mesh, [100], 3).sum()
    assert not frozen_faces(mesh).any()


def test_smallest_feasible_of_plain_shapes():
    assert smallest_feasible(Mesh(SPHERE.vertices, SPHERE.faces)) == 4
    assert smallest_feasible(Mesh(TORUS.vertices, TORUS.faces)) >= 14  # a torus has no triangulation below 14 faces


def test_a_loose_triangle_asks_for_its_one_face():
    corners = np.arange(90).reshape(-1, 3) % 7 + 3.0 * np.arange(30)[:, None]  # ten triangles that share no vertex
    loose = Mesh(
        np.r_[SPHERE.vertices, corners], np.r_[SPHERE.faces, len(SPHERE.vertices) + np.arange(30).reshape(-1, 3)]
    )
    assert smallest_feasible(loose) == smallest_feasible(loose, free_borders=True) == 14


def flower():
    away = np.hypot(*SPHERE.vertices.T[:2])
    petals = 1 + 1.4 * np.cos(9 * np.arctan2(*SPHERE.vertices.T[:2])) * away
    return Mesh(SPHERE.vertices * petals[:, None], SPHERE.faces)


def cup():
    x, y, z = SPHERE.vertices.T
    inside = np.where(z > 0, 0.9, 1.0)
    return Mesh(np.c_[inside * x, inside * y, -inside * np.abs(z)], SPHERE.faces)


def blade():
    return Mesh(SPHERE.vertices * [1, 0.1, 0.02], SPHERE.faces)


@pytest.mark.parametrize("make", [flower, cup, blade])
@pytest.mark.parametrize(("keep", "shrink"), [([], False), ([5, 300, 600], False), ([5], True)])
def test_the_count_that_an_infeasible_target_names_can_be_had(make, keep, shrink):
    # The floor of `smallest_feasible` is no promise: most of these end above it.
    mesh = make()
    with pytest.raises(InfeasibleTarget) as caught:
        simplify(mesh, 2, keep, 2, shrink=shrink)
    simple = simplify(mesh, caught.value.smallest, keep, 2, shrink=shrink)
    assert len(simple.faces) <= caught.value.smallest
    assert topology(simple.faces) == topology(mesh.faces)
    assert not faults(simple).added(faults(mesh))


def test_neighbourhoods_shrink_until_the_backend_gives_in(monkeypatch):
    mesh, keep, requests = Mesh(SPHERE.vertices, SPHERE.faces), np.arange(0, 640, 80), []

    def stubborn(mesh, faces, frozen, weights):
        requests.append(int(frozen.sum()))
        if frozen.sum() > 40:
            raise InfeasibleTarget(faces, faces + 50, int(frozen.sum()))
        return mesh

    monkeypatch.setitem(BACKENDS, "fast", stubborn)
    assert np.array_equal(simplify(mesh, 900, keep, 2, shrink=True).vertices, mesh.vertices)
    assert (
        requests == sorted(requests, reverse=True)
        and requests[0] == frozen_faces(mesh, keep, 2).sum()
        and 0 < requests[-1] <= 40
    )


def test_the_smallest_count_is_searched_for_once_for_all_refused_targets(monkeypatch):
    mesh, requests = Mesh(SPHERE.vertices, SPHERE.faces), []

    def stubborn(mesh, faces, frozen, weights):
        requests.append((faces, int(frozen.sum())))
        if faces < 200 + frozen.sum():
            raise InfeasibleTarget(faces, max(faces + 10, 180), int(frozen.sum()))
        return Mesh(mesh.vertices, mesh.faces[: faces - 5])

    monkeypatch.setitem(BACKENDS, "fast", stubborn)
    for target, keep, calls, smallest in ((100, [], 4, 195), (120, [], 1, 195), (100, [0], 5, 205)):
        requests.clear()
        with pytest.raises(InfeasibleTarget) as caught:
            simplify(mesh, target, keep, 1)
        assert (len(requests), caught.value.smallest) == (calls, smallest)


def test_infeasible_target_travels_between_processes():
    error = pickle.loads(pickle.dumps(InfeasibleTarget(100, 250, 80)))
    assert isinstance(error, ValueError)
    assert (error.faces, error.smallest, error.frozen) == (100, 250, 80)
    with pytest.raises(ValueError, match="250"):
        raise error


KEEP = np.array([11, 900, 1500, 2200, 60, 1234])


def walk(rings):
    """The states that neighbourhoods pass through, one step after the other, written out plainly."""
    rings, states = list(rings), [list(rings)]
    while max(rings) > 0:
        for i in reversed(range(len(rings))):
            if rings[i] > 0:
                rings[i] -= 1
                states.append(list(rings))
    for i in reversed(range(len(rings))):
        if rings[i] == 0:
            rings[i] = -1
            states.append(list(rings))
    return states


@pytest.mark.parametrize(("rings", "faces"), [([3] * 6, 150), ([3] * 6, 450), ([1, 4, 2, 0, -1, 3], 20)])
def test_the_first_feasible_state_of_the_walk_is_taken(rings, faces):
    states = walk(rings)
    first = next(state for state in states if smallest_feasible(LARGE, KEEP, np.array(state)) <= faces)
    assert shrunk_rings(LARGE, smallest_feasible(LARGE, KEEP, np.array(rings)), KEEP, np.array(rings)).tolist() == rings
    assert shrunk_rings(LARGE, faces, KEEP, np.array(rings)).tolist() == first


def test_nothing_kept_has_nothing_to_shrink_and_a_target_below_the_mesh_itself_is_infeasible():
    ring = Mesh(TORUS.vertices, TORUS.faces)
    assert shrunk_rings(ring, 100, None).shape == (0,)
    with pytest.raises(InfeasibleTarget) as caught:
        shrunk_rings(ring, 10, [3])
    assert (caught.value.frozen, caught.value.smallest) == (0, smallest_feasible(ring))
