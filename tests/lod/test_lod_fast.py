"""The compiled backend: what once went wrong in it."""

import numpy as np
import trimesh

from stages.kit import Mesh
from stages.lod import frozen_faces, metro
from stages.lod.fast import collapse
from stages.lod.topology import faults, topology


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


def test_the_fit_brings_the_surface_nearer():
    mesh = bumpy()
    smooth = Mesh(mesh.vertices / np.linalg.norm(mesh.vertices, axis=1)[:, None], mesh.faces)
    found = collapse(smooth, 200, nothing(smooth))
    inscribed = trimesh.creation.icosphere(subdivisions=2)  # 320 faces, all corners on the sphere
    assert metro(smooth, found)["mean"] < metro(smooth, Mesh(inscribed.vertices, inscribed.faces))["mean"]


def test_equal_meshes_give_equal_bytes():
    first, second = (collapse(bumpy(), 400, nothing(bumpy())) for _ in range(2))
    assert first.vertices.tobytes() == second.vertices.tobytes()
    assert first.faces.tobytes() == second.faces.tobytes()
