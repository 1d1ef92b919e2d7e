"""Each way to break a mesh does what its name says, and the same twice."""

import numpy as np
import pytest
import trimesh

from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh
from stages.stability.broken import DAMAGES, SLIVER_HEIGHT
from stages.stability.surface import Surface

BALL = trimesh.creation.icosphere(subdivisions=3)
SOUND = Mesh(BALL.vertices * [0.3, 0.4, 0.5], BALL.faces)
# What is counted on the broken ball: rim edges, pieces, faces without area, crowded edges, fans beside others.
COUNTS = {
    "sound": (0, 1, 0, 0, 0),
    "fins": (60, 21, 0, 20, None),
    "burrs": (0, 21, 0, 0, 20),
    "interpenetrating": (0, 2, 0, 0, 0),
    "double_layer": (0, 2560, 0, 1920, None),
    "zero_area": (0, 1, 200, 0, 0),
    "repeated_index": (0, None, 50, None, None),
    "islands": (0, 201, 0, 0, 0),
    "mixed_winding": (0, 1, 0, 0, 0),
    "unreferenced": (0, 1, 0, 0, 0),
    "soup": (0, 1280, 0, 0, 0),
    "squashed": (0, 1, None, 0, 0),
    "flat_sheet": (160, 1, 0, 0, 0),
    "moebius": (240, 1, 0, 0, 0),
    "one_triangle": (3, 1, 0, 0, 0),
}


def broken(name):
    return DAMAGES[name].make(SOUND, rng(0, name))


@pytest.mark.parametrize("name", DAMAGES)
def test_equal_draws_give_equal_bytes_and_the_sound_mesh_stays(name):
    before = SOUND.vertices.copy(), SOUND.faces.copy()
    first, second = broken(name), broken(name)
    assert first.vertices.tobytes() == second.vertices.tobytes() and first.faces.tobytes() == second.faces.tobytes()
    assert np.array_equal(SOUND.vertices, before[0]) and np.array_equal(SOUND.faces, before[1])


@pytest.mark.slow
@pytest.mark.parametrize("name", COUNTS)
def test_the_damage_is_the_one_that_the_name_says(name):
    surface = Surface(broken(name))
    counts = (
        len(surface.boundary_edges),
        surface.components,
        surface.degenerate_faces,
        surface.non_manifold_edges,
        surface.non_manifold_vertices,
    )
    for value, wanted in zip(counts, COUNTS[name], strict=True):
        assert wanted is None or value == wanted


def test_needles_are_as_thin_as_they_say():
    mesh = broken("needles")
    longest = np.linalg.norm(np.diff(mesh.vertices[mesh.faces[:, [0, 1, 2, 0]]], axis=1), axis=2).max(axis=1)
    slimness = np.sort(2 * mesh.face_areas / longest**2)
    assert slimness[0] > 0 and slimness[199] < SLIVER_HEIGHT < slimness[200]


@pytest.mark.slow
def test_mixed_winding_cannot_be_told_inside_from_outside_and_a_moebius_strip_never():
    assert not Surface(broken("mixed_winding")).as_trimesh.is_winding_consistent
    strip = trimesh.Trimesh(*(getattr(broken("moebius"), name) for name in ("vertices", "faces")), process=False)
    trimesh.repair.fix_winding(strip)
    assert not strip.is_winding_consistent


def test_a_seam_leaves_the_surface_closed_in_space_and_holes_and_halves_are_open():
    mesh = broken("seam")
    assert len(np.unique(mesh.vertices, axis=0)) < len(mesh.vertices) and not mesh.watertight
    assert not Surface(mesh).boundary_edges
    assert 40 < len(Surface(broken("pin_holes")).boundary_edges) <= 60
    assert len(Surface(broken("wide_holes")).boundary_edges) > 20 and len(Surface(broken("half")).boundary_edges) > 20


def test_noise_has_its_sigma_and_other_units_and_origins_keep_the_shape():
    for sigma in (0.001, 0.01):
        steps = broken(f"noise_{sigma}").vertices - SOUND.vertices
        assert steps.std() / SOUND.diagonal == pytest.approx(sigma, rel=0.1)
    for name in ("tiny", "huge"):
        mesh = broken(name)
        assert np.allclose(mesh.vertices / mesh.diagonal, SOUND.vertices / SOUND.diagonal, atol=1e-9)
    assert np.abs(broken("far").vertices).min() > 1e5 * SOUND.diagonal
