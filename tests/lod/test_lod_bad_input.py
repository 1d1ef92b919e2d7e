"""Whatever the mesh, the kept set and the target: the result is sound, or the error says why."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from haptic_glance.lod import InfeasibleTarget, SimplifyError, frozen_faces, shrunk_rings, simplify, smallest_feasible
from haptic_glance.lod.topology import faults, topology
from haptic_glance.mesh.mesh import Mesh

BALL = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
RING = trimesh.creation.torus(0.35, 0.12, major_sections=20, minor_sections=10)
SPIKE = [[0.0, 0.0, 0.9]]


def sheet(side=12):
    x, y = np.meshgrid(np.linspace(-0.4, 0.4, side), np.linspace(-0.4, 0.4, side), indexing="ij")
    a = np.arange(side * side).reshape(side, side)[:-1, :-1].ravel()
    faces = np.r_[np.c_[a, a + side, a + 1], np.c_[a + 1, a + side, a + side + 1]]
    return Mesh(np.c_[x.ravel(), y.ravel(), 0.1 * np.sin(9 * x.ravel())], faces)


def finned():
    """A ball with a fin on one of its edges: that edge has three faces."""
    return Mesh(np.r_[BALL.vertices, SPIKE], np.r_[BALL.faces, [[*BALL.faces[0, :2], len(BALL.vertices)]]])


MESHES = {
    "ball": Mesh(BALL.vertices, BALL.faces),
    "torus": Mesh(RING.vertices, RING.faces),
    "open sheet": sheet(),
    "flat sheet": Mesh(sheet().vertices * [1, 1, 0], sheet().faces),
    "two components far apart": Mesh(
        np.r_[BALL.vertices, BALL.vertices * 0.01 + [40, 0, 0]], np.r_[BALL.faces, BALL.faces + len(BALL.vertices)]
    ),
    "inward normals": Mesh(BALL.vertices, BALL.faces[:, ::-1]),
    "three faces on an edge": finned(),
    "a vertex in no face": Mesh(np.r_[BALL.vertices, SPIKE], BALL.faces),
    "coincident vertices": Mesh(BALL.vertices[BALL.faces].reshape(-1, 3), np.arange(BALL.faces.size).reshape(-1, 3)),
    "doubled face": Mesh(BALL.vertices, np.r_[BALL.faces, BALL.faces[:1]]),
    "degenerate face": Mesh(BALL.vertices, np.r_[BALL.faces, [[0, 0, 1]]]),
    "one triangle": Mesh(np.eye(3), [[0, 1, 2]]),
    "tetrahedron": Mesh(np.r_[np.eye(3), [[0, 0, 0]]], [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]),
}


def check_sound(mesh, found, faces, keep, rings):
    assert len(found.faces) <= max(faces, 1)
    assert np.isfinite(found.vertices).all()
    assert not faults(found).added(faults(mesh))
    before, after = topology(mesh.faces), topology(found.faces)
    assert (after.components, after.closed_components, after.boundary_edges, after.boundary_loops) == (
        before.components, before.closed_components, before.boundary_edges, before.boundary_loops,
    )  # fmt: skip
    held = {place.tobytes() for place in found.vertices}
    kept = np.unique(mesh.faces[frozen_faces(mesh, keep, rings)])
    assert all(mesh.vertices[vertex].tobytes() in held for vertex in kept)


@pytest.mark.slow
@pytest.mark.parametrize("name", MESHES)
@settings(max_examples=12, deadline=None, derandomize=True)
@given(data=st.data())
def test_any_kept_set_and_any_target_give_a_sound_mesh_or_a_reason(name, data):
    mesh = MESHES[name]
    total, n = len(mesh.faces), len(mesh.vertices)
    keep = data.draw(st.lists(st.integers(0, n - 1), max_size=12, unique=True), "keep")
    rings = np.array([data.draw(st.integers(-1, 4), "rings") for _ in keep], dtype=int)
    faces, shrink = data.draw(st.integers(1, total), "faces"), data.draw(st.booleans(), "shrink")
    try:
        found = simplify(mesh, faces, keep, rings, shrink=shrink)
    except InfeasibleTarget as error:
        assert error.smallest > faces
        return
    except SimplifyError as error:
        assert "new" in str(error)
        return
    if shrink:
        rings = shrunk_rings(mesh, faces, keep, rings)
    if faces < total:
        check_sound(mesh, found, faces, keep, rings)
    else:
        assert found is mesh


@pytest.mark.parametrize("name", MESHES)
def test_everything_kept_leaves_the_mesh_or_is_infeasible(name):
    mesh = MESHES[name]
    everything = np.unique(mesh.faces)
    assert smallest_feasible(mesh, everything) == len(mesh.faces)
    assert simplify(mesh, len(mesh.faces), everything) is mesh
    if len(mesh.faces) > 1:
        with pytest.raises(InfeasibleTarget):
            simplify(mesh, len(mesh.faces) - 1, everything)


@pytest.mark.parametrize("name", ["ball", "torus", "open sheet", "three faces on an edge"])
def test_repeated_runs_give_the_same_bytes(name):
    mesh, keep = MESHES[name], [3, 40, 77]
    first = [simplify(mesh, len(mesh.faces) // 2, keep, shrink=True) for _ in range(2)]
    assert first[0].vertices.tobytes() == first[1].vertices.tobytes()
    assert first[0].faces.tobytes() == first[1].faces.tobytes()
