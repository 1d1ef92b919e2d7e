"""The frame of a mesh, and the vertices that stand for it."""

import numpy as np
import pytest

from haptic_glance.look.rivals.samples import samples, unit_mesh
from haptic_glance.mesh.mesh import Mesh


@pytest.fixture(scope="module")
def long(sphere):
    return Mesh(sphere(3).vertices * [3, 2, 1] + 0.1 * np.sin(9 * sphere(3).vertices), sphere(3).faces)


def test_the_frame_does_not_depend_on_order_size_and_place(long):
    order = np.random.default_rng(3).permutation(len(long.vertices))
    moved = Mesh(7 * long.vertices[order] + [4, 5, 6], np.argsort(order)[long.faces])
    one, other = unit_mesh(long), unit_mesh(moved)
    assert np.allclose(one.mesh.vertices, other.mesh.vertices, atol=1e-8)
    assert 2 * np.linalg.norm(one.mesh.vertices, axis=1).max() == pytest.approx(1)
    heights = one.mesh.vertices[:, 0]
    assert np.allclose(one.to_vertices(heights)[order], other.to_vertices(heights))


def test_vertices_in_one_place_are_one_and_the_others_are_left_out(long):
    soup = Mesh(
        np.concatenate([long.vertices[long.faces].reshape(-1, 3), [[99, 0, 0]]]), np.arange(3840).reshape(-1, 3)
    )
    unit = unit_mesh(soup)
    assert len(unit.mesh.vertices) == len(long.vertices) and unit.place[-1] == -1
    assert unit.to_vertices(np.ones(len(long.vertices))).sum() == 3840


def test_a_mesh_without_area_has_no_frame():
    assert unit_mesh(Mesh(np.zeros((3, 3)), [[0, 1, 2]])) is None


def test_samples_are_even_and_joined_to_their_neighbours(long):
    mesh = unit_mesh(long).mesh
    few = samples(mesh, 60)
    apart = np.linalg.norm(mesh.vertices[few.ids][:, None] - mesh.vertices[few.ids], axis=2)
    near = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices[few.ids], axis=2).min(axis=1)
    assert near.max() <= (apart + np.eye(60)).min()  # farthest first: none is farther from all than two from each other
    assert np.array_equal(few.owner[few.ids], np.arange(60))
    assert abs(few.graph.nnz / 60 - 6) < 0.5 and (few.graph != few.graph.T).nnz == 0  # a triangulation's mean degree


def test_all_vertices_of_a_small_mesh_stand_for_it(long):
    mesh = unit_mesh(long).mesh
    few = samples(mesh, 9999)
    assert np.array_equal(few.owner, np.arange(len(mesh.vertices))) and few.graph.nnz == mesh.adjacency.nnz


def test_what_is_spread_stays_where_it_was(long):
    mesh = unit_mesh(long).mesh
    few = samples(mesh, 200)
    spread = few.spread(mesh, mesh.vertices[few.ids, 0])
    assert np.abs(spread - mesh.vertices[:, 0]).max() < 0.15 and np.corrcoef(spread, mesh.vertices[:, 0])[0, 1] > 0.99
