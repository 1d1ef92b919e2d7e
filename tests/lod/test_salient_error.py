"""The error where people look, against damage whose place is known."""

import numpy as np
import pytest
import trimesh

from haptic_glance.lod import metro
from haptic_glance.lod.errors import salient_error, surface_errors
from haptic_glance.mesh.mesh import Mesh

BALL = trimesh.creation.icosphere(subdivisions=4, radius=0.5)
SPHERE = Mesh(BALL.vertices, BALL.faces)
UPPER = (SPHERE.vertices[:, 2] > 0.25).astype(float)


def dented(side):
    """The sphere with the cap of one side, +1 above or -1 below, pressed in by a tenth."""
    vertices = SPHERE.vertices.copy()
    cap = side * vertices[:, 2] > 0.35
    vertices[cap] *= 0.9
    return Mesh(vertices, SPHERE.faces)


@pytest.mark.slow
def test_equal_saliency_is_metro():
    damaged = dented(1)
    for level in (1.0, 7.0):
        found = salient_error(SPHERE, damaged, np.full(len(UPPER), level), 2000)
        assert found == pytest.approx(metro(SPHERE, damaged, 2000)["mean"], rel=1e-12)


def test_damage_where_nobody_looks_is_no_error():
    assert salient_error(SPHERE, dented(-1), UPPER, 2000) < 1e-12
    assert metro(SPHERE, dented(-1), 2000)["mean"] > 1e-3


def test_damage_where_people_look_counts_more_than_in_metro():
    assert salient_error(SPHERE, dented(1), UPPER, 2000) > 2 * metro(SPHERE, dented(1), 2000)["mean"]


def test_two_planes_are_their_distance_apart_wherever_one_looks():
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    one = Mesh(corners, [[0, 1, 2], [0, 2, 3]])
    other = Mesh(corners + [0, 0, 0.25], one.faces)
    assert salient_error(one, other, [0, 0, 1, 0], 500) == pytest.approx(0.25 / np.sqrt(2), rel=1e-12)


def test_a_tilted_plane_is_weighted_by_the_saliency_there():
    # Height 0.1 x over a square whose saliency is x: the mean of x weighted by x is 2 / 3; the tilt shortens it.
    corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
    flat = Mesh(corners, [[0, 1, 2], [0, 2, 3]])
    tilted = Mesh(corners + 0.1 * corners[:, :1] * [0, 0, 1], flat.faces)
    expected = 0.1 * 2 / 3 / np.sqrt(2)
    assert salient_error(flat, tilted, corners[:, 0], 20_000) == pytest.approx(expected, rel=0.02)


def test_scale_of_the_saliency_and_of_the_meshes_does_not_matter():
    damaged = dented(1)
    saliency = np.random.default_rng(0).random(len(UPPER))
    value = salient_error(SPHERE, damaged, saliency, 1000)
    larger = [Mesh(4 * mesh.vertices, mesh.faces) for mesh in (SPHERE, damaged)]
    assert salient_error(*larger, 10 * saliency, 1000) == pytest.approx(value, rel=1e-12)


def test_all_errors_come_from_one_sampling():
    damaged = dented(1)
    found = surface_errors(SPHERE, damaged, {"salient": UPPER}, 1000, seed=3)
    assert {name: found[name] for name in ("mean", "rms", "max")} == metro(SPHERE, damaged, 1000, seed=3)
    assert found["salient"] == salient_error(SPHERE, damaged, UPPER, 1000, seed=3)


def test_a_mesh_has_no_error_to_itself():
    assert salient_error(SPHERE, SPHERE, UPPER, 1000) < 1e-15


@pytest.mark.parametrize(
    ("saliency", "said"),
    [
        (np.zeros(len(UPPER)), "zero on the whole surface"),
        (np.ones(3), "one value per vertex"),
        (-UPPER, "0 or more"),
        (np.full(len(UPPER), np.nan), "finite"),
    ],
)
def test_bad_saliency_is_named(saliency, said):
    with pytest.raises(ValueError, match=said):
        salient_error(SPHERE, SPHERE, saliency, 100)


def test_saliency_that_no_sample_meets_is_named():
    one = np.zeros(len(UPPER))
    one[0] = 1
    with pytest.raises(ValueError, match="more samples"):
        salient_error(SPHERE, SPHERE, one, 3)
