"""Amounts spread over the surface: a Gaussian in the plane, everything kept, nothing through walls or gaps."""

import numpy as np
import pytest

from haptic_glance.mesh.mesh import Mesh
from stages.weights.ground_truth import spread_on_surface


def grid(k, jitter=0.0, turned=False):
    """A square of side 2 in the plane z = 0 with k x k vertices, the middle one at the origin."""
    steps = np.linspace(-1, 1, k)
    places = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1)
    moves = np.random.default_rng(0).uniform(-jitter, jitter, places.shape) * 2 / (k - 1)
    moves[[0, -1]] = moves[:, [0, -1]] = moves[k // 2, k // 2] = 0
    ids = np.arange(k * k).reshape(k, k)
    a, b, c, d = ids[:-1, :-1].ravel(), ids[1:, :-1].ravel(), ids[1:, 1:].ravel(), ids[:-1, 1:].ravel()
    faces = [np.c_[a, b, d], np.c_[b, c, d]] if turned else [np.c_[a, b, c], np.c_[a, c, d]]
    return Mesh(np.c_[(places + moves).reshape(-1, 2), np.zeros(k * k)], np.concatenate(faces))


def at(mesh, vertex, amount=1.0):
    amounts = np.zeros(len(mesh.vertices))
    amounts[vertex] = amount
    return amounts


def gaussian(mesh, sigma):
    return np.exp(-(mesh.vertices**2).sum(axis=1) / (2 * sigma**2)) / (2 * np.pi * sigma**2)


@pytest.mark.parametrize("mesh", [grid(61, turned=True), grid(61, 0.45)])
def test_a_point_becomes_the_gaussian_on_a_plane_however_it_is_meshed(mesh):
    density = spread_on_surface(mesh, at(mesh, 61 * 61 // 2), 0.15)
    truth = gaussian(mesh, 0.15)
    assert mesh.vertex_areas @ np.abs(density - truth) < 0.04
    assert np.abs(density - truth).max() < 0.06 * truth.max()
    deviation = np.sqrt(mesh.vertex_areas @ (density * (mesh.vertices**2).sum(axis=1)) / 2)
    assert deviation == pytest.approx(0.15, rel=0.01)


@pytest.mark.parametrize("sigma", [1e-6, 0.3, 50.0])
def test_amounts_are_kept_and_never_negative(sigma):
    mesh = grid(21, 0.4)
    amounts = np.random.default_rng(1).exponential(size=len(mesh.vertices))
    density = spread_on_surface(mesh, amounts, sigma)
    assert mesh.vertex_areas @ density == pytest.approx(amounts.sum(), rel=1e-9)
    assert density.min() >= 0


def test_nothing_reaches_a_separate_piece():
    single = grid(11)
    pair = Mesh(
        np.r_[single.vertices, single.vertices + (0, 0, 1e-3)], np.r_[single.faces, single.faces + len(single.vertices)]
    )
    density = spread_on_surface(pair, at(pair, 60), 0.5)
    assert (density[len(single.vertices) :] == 0).all() and (density[: len(single.vertices)] > 0).all()


def test_heat_goes_round_a_thin_fold_and_not_through_it():
    flat = grid(41)
    x, y, _ = flat.vertices.T
    folded = Mesh(np.c_[np.abs(x), y, np.where(x > 0, 1e-3, 0)], flat.faces)
    vertex = int(np.argmin((x + 0.8) ** 2 + y**2))
    opposite = int(np.argmin((x - 0.8) ** 2 + y**2))
    density = spread_on_surface(folded, at(folded, vertex), 0.1)
    assert np.linalg.norm(folded.vertices[vertex] - folded.vertices[opposite]) < 2e-3
    assert density[opposite] < 1e-6 * density[vertex]
    near, beyond = np.argmin((x + 0.1) ** 2 + y**2), np.argmin((x - 0.1) ** 2 + y**2)
    wide = spread_on_surface(folded, at(folded, near), 0.1)
    assert wide[beyond] > 0.05 * wide[near]  # 0.2 away round the fold: exp(-2) of the peak


def test_density_follows_renumbered_vertices_and_is_per_area_of_a_larger_and_turned_mesh():
    mesh = grid(21, 0.3)
    order = np.random.default_rng(2).permutation(len(mesh.vertices))
    turn = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
    moved = Mesh(1000 * mesh.vertices[order] @ turn.T + 7, np.argsort(order)[mesh.faces][::-1])
    amounts = np.random.default_rng(3).exponential(size=len(order))
    density = spread_on_surface(mesh, amounts, 0.1)
    np.testing.assert_allclose(1e6 * spread_on_surface(moved, amounts[order], 100.0), density[order], rtol=1e-5)


def test_a_seam_of_doubled_vertices_does_not_stop_the_flow():
    mesh = grid(21)
    corners = Mesh(mesh.vertices[mesh.faces.ravel()], np.arange(mesh.faces.size).reshape(-1, 3))
    corner = int(np.flatnonzero(mesh.faces.ravel() == 220)[0])
    density = spread_on_surface(corners, at(corners, corner), 0.2)
    np.testing.assert_allclose(density, spread_on_surface(mesh, at(mesh, 220), 0.2)[mesh.faces.ravel()], rtol=1e-9)


def test_bad_meshes_have_finite_densities():
    lone = Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (9, 9, 9)], [(0, 1, 2)])
    assert np.isfinite(spread_on_surface(lone, at(lone, 0), 0.5)).all()
    needle = Mesh([(0, 0, 0), (1, 0, 0), (0.5, 1e-14, 0), (0.5, 1, 0)], [(0, 1, 2), (1, 3, 2), (3, 0, 2), (1, 1, 2)])
    density = spread_on_surface(needle, at(needle, 2), 0.2)
    assert np.isfinite(density).all() and needle.vertex_areas @ density == pytest.approx(1, rel=1e-4)
    inward = Mesh(needle.vertices, needle.faces[:, ::-1])
    np.testing.assert_allclose(spread_on_surface(inward, at(inward, 2), 0.2), density, rtol=1e-3)
    assert (spread_on_surface(lone, np.zeros(4), 0.5) == 0).all()
