"""Spectral saliency (Song 2014) on spectra and shapes whose irregular parts are known."""

import numpy as np
import pytest
from scipy import sparse
from scipy.spatial.transform import Rotation

from haptic_glance.look.rivals import song
from haptic_glance.mesh.mesh import Mesh


@pytest.fixture(autouse=True)
def few(monkeypatch):
    monkeypatch.setattr(song, "SAMPLES", 300)


def test_an_even_spectrum_is_regular_and_a_step_is_not():
    even = np.exp(0.1 * np.arange(60))
    rough = song.irregularity(np.concatenate([[0], even]))
    assert rough[0] == 0 and np.allclose(rough[5:-4], 0)
    step = song.irregularity(np.where(np.arange(60) < 30, even, 3 * even))
    assert step.argmax() in (29, 30) and step.max() == pytest.approx(np.log(3) * 4 / 9)


def test_equal_eigenvalues_are_equally_irregular():
    rough = song.irregularity(np.array([1.0, 2, 2, 2, 3, 5, 9, 17, 30, 50, 99]))
    assert rough[1] == rough[2] == rough[3] and len(set(rough)) > 3


def test_it_is_the_sum_over_the_edges_of_the_filtered_laplacian():
    """A path of three at distances one and two: eigenvalues of its Laplacian by numpy, the sum by hand."""
    positions = np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0]])
    graph = sparse.csr_matrix(np.array([[0, 1, 0], [1, 0, 2], [0, 2, 0]]))
    laplacian = np.array([[1, -1, 0], [-1, 1.25, -0.25], [0, -0.25, 0.25]])
    values, functions = np.linalg.eigh(laplacian)
    ratio = np.log(values[2] / values[1])
    rough = np.exp([0, ratio * 4 / 9, ratio * 4 / 9])  # ends repeated: four of nine are other
    kernel = functions @ np.diag(rough) @ functions.T
    expected = [kernel[0, 1], kernel[0, 1] + kernel[1, 2] / 4, kernel[1, 2] / 4]
    assert song.spectral_saliency(positions, graph) == pytest.approx(np.array(expected))


@pytest.mark.slow
def test_a_bump_is_salient_and_a_ball_is_even(raised, sphere):
    ball = raised([[1, 0, 0]], [0.15], [0.3], subdivisions=4)
    values, plain = song.saliency(ball), song.saliency(sphere(4))
    on_it = ball.vertices[:, 0] / np.linalg.norm(ball.vertices, axis=1) > np.cos(0.3)
    assert values[on_it].mean() > 2 * values[~on_it].mean()
    assert np.ptp(values) > 100 * np.ptp(plain) and np.ptp(plain) < 0.1 * plain.max()


@pytest.mark.slow
def test_a_turned_and_scaled_mesh_keeps_its_map(raised, monkeypatch):
    """But for ties between samples, of which a ball has many: here all vertices are samples."""
    monkeypatch.setattr(song, "SAMPLES", 700)
    mesh = raised([[1, 0, 0], [0, 0.6, 0.8]], [0.4, 0.3], [0.5, 0.4], subdivisions=2)
    turn = Rotation.from_euler("xyz", [20, 30, 50], degrees=True).as_matrix()
    turned = Mesh(1e5 * (mesh.vertices @ turn.T + [3, -2, 1]), mesh.faces)
    assert np.corrcoef(song.saliency(mesh), song.saliency(turned))[0, 1] > 0.9999
