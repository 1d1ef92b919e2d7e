"""Regions of interest (Leifman 2012) on shapes whose distinct parts and limbs are known."""

import numpy as np
import pytest
from scipy.sparse.csgraph import dijkstra

from haptic_glance.look.kernels import spin_images
from haptic_glance.look.rivals import leifman
from haptic_glance.look.rivals.samples import samples, unit_mesh
from haptic_glance.mesh.mesh import Mesh

UP = np.array([[0.0, 0, 1]])


@pytest.fixture(autouse=True)
def few(monkeypatch):
    monkeypatch.setattr(leifman, "SAMPLES", 400)


def ends(mesh):
    unit = unit_mesh(mesh).mesh
    some = samples(unit, leifman.SAMPLES)
    return unit.vertices[some.ids[leifman.limb_ends(dijkstra(some.graph, directed=False))]]


def test_a_spin_image_holds_heights_and_distances():
    """Half a bin lies between a bin's edge and its middle: 1.5 bins up and 2.5 aside are the middle of a bin."""
    image = spin_images(np.array([[2.5, 0, 1.5], [0, 0, 9]]), np.array([3.0, 1]), np.zeros((1, 3)), UP, 4.0, 4)[0]
    assert image.shape == (8, 4) and image[5, 2] == pytest.approx(1)
    between = spin_images(np.array([[0, 2.0, -1.5]]), np.array([3.0]), np.zeros((1, 3)), UP, 4.0, 4)[0]
    assert between[2, 1:3] == pytest.approx([0.5, 0.5])


def test_the_diffusion_distance_grows_with_the_shift():
    """A city-block distance of the images alone would be two for each."""
    images = np.zeros((4, 16, 8))
    images[range(4), 4, [0, 1, 2, 4]] = 1
    levels = leifman.pyramid(images)
    distances = np.abs(levels[1:] - levels[0]).sum(axis=1)
    assert 2 < distances[0] < distances[1] < distances[2]
    mirrored = leifman.pyramid(images[:, ::-1])
    assert np.allclose(np.abs(mirrored[1:] - mirrored[0]).sum(axis=1), distances)


def test_what_lies_near_a_focus_shares_its_distinctness():
    """Ten vertices on a line, sigma apart, the first two of them foci."""
    steps = np.arange(10)
    found = leifman.association(np.array([0.9, 0.8] + 8 * [0.1]), leifman.SIGMA * np.abs(steps[:, None] - steps))
    assert found == pytest.approx(np.append(0.9, 0.8 * np.exp(-(steps[:9] ** 2) / 2)))


def test_the_ends_of_limbs_are_of_interest_though_nothing_is_distinct(sphere, monkeypatch):
    monkeypatch.setattr(leifman, "FLOOR", 9)
    ball = sphere(3)
    values = leifman.saliency(Mesh(ball.vertices * [3, 1, 1], ball.faces))
    along = np.abs(ball.vertices[:, 0])
    assert values[along > 0.98].min() > 0.4 and values[along < 0.5].max() < 0.01


@pytest.mark.slow
def test_a_bump_is_of_interest_and_the_ball_under_it_is_not(raised):
    ball = raised([[1, 0, 0]], [0.15], [0.3], subdivisions=4)
    values = leifman.saliency(ball)
    top = ball.vertices[:, 0].argmax()
    assert values[top] > 0.5 and values[ball.vertices[:, 0] < 0].max() < 0.1
    assert np.linalg.norm(ball.vertices[leifman.points(ball, values)[0]] - ball.vertices[top]) < 0.2


def test_a_ball_has_no_limbs_and_a_long_body_two(sphere):
    assert not len(ends(sphere(3))) and not leifman.saliency(sphere(3)).any()
    long = ends(Mesh(sphere(3).vertices * [3, 1, 1], sphere(3).faces))
    assert np.allclose(np.abs(long), [[0.5, 0, 0]] * 2, atol=0.03)


def test_each_part_has_limbs_of_its_own(sphere):
    long, ball = sphere(3).vertices * [3, 1, 1], sphere(3)
    both = Mesh(np.concatenate([long, ball.vertices + [0, 5, 0]]), np.concatenate([ball.faces, ball.faces + len(long)]))
    found = ends(both)
    assert len(found) == 2 and np.ptp(found[:, 0]) > 10 * np.ptp(found[:, 1])
