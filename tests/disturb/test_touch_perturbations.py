"""Perturbations of touch on a shape whose imprints are known."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from haptic_glance.disturb.touch_disturbances import (
    TOUCH_PERTURBATIONS,
    Touches,
    rotations_about,
    snap_with_blended_normals,
)
from haptic_glance.mesh.mesh import Mesh


@pytest.fixture(scope="module")
def mesh():
    """An ellipsoid of three unequal axes: curved differently in every place and direction."""
    ball = trimesh.creation.icosphere(subdivisions=3)
    return Mesh(ball.vertices * [0.5, 0.35, 0.22], ball.faces)


def touches_of(mesh, **more):
    return Touches("egg", mesh, np.arange(0, 600, 60), (16, 16), 0.02, **more)


@pytest.fixture(scope="module")
def touches(mesh):
    return touches_of(mesh, saliency=np.linspace(0, 1, len(mesh.vertices)))


def test_a_turn_about_the_vertical_moves_places_and_leaves_imprints(touches):
    perturbed = TOUCH_PERTURBATIONS["object_turned"].apply(touches, 90.0, 0)
    upright = np.abs(touches.normals[:, 2]) < 0.95  # at the poles the array's "up" is another
    assert np.allclose(perturbed.images[upright], touches.images[upright], atol=1e-4)
    assert np.allclose(perturbed.positions, touches.positions[:, [1, 0, 2]] * [-1, 1, 1])


def test_a_turned_object_feels_as_its_turned_mesh_does(mesh, touches):
    perturbed = TOUCH_PERTURBATIONS["object_tilted"].apply(touches, 40.0, 0)
    azimuth = touches.random("object_tilted", 0).uniform(0, 2 * np.pi)
    rotation = rotations_about(np.array([np.cos(azimuth), np.sin(azimuth), 0.0]), np.float64(40.0))
    tilted = touches_of(Mesh(mesh.vertices @ rotation.T, mesh.faces))
    assert np.allclose(perturbed.images, tilted.images, atol=1e-3)
    assert np.allclose(perturbed.positions, tilted.positions)


def test_a_scaled_object_feels_as_its_scaled_mesh_does(mesh, touches):
    perturbed = TOUCH_PERTURBATIONS["object_larger"].apply(touches, 1.5, 0)
    larger = touches_of(Mesh(1.5 * mesh.vertices, mesh.faces))
    assert np.allclose(perturbed.images, larger.images, atol=1e-3)


def test_a_missed_place_is_on_the_surface_and_no_farther_than_the_error(touches):
    perturbed = TOUCH_PERTURBATIONS["localisation"].apply(touches, 0.05, 0)
    gaps = np.linalg.norm(perturbed.positions - touches.positions, axis=1)
    back, _ = snap_with_blended_normals(touches.mesh, perturbed.positions)
    assert np.allclose(back, perturbed.positions, atol=1e-6)
    assert gaps.max() < 0.051 and gaps.min() > 0.02
    positions, normals = snap_with_blended_normals(touches.mesh, touches.positions)
    assert np.allclose(positions, touches.positions) and np.allclose(normals, touches.normals, atol=1e-6)


def test_a_simplified_mesh_that_is_there_is_used(mesh):
    flat = Mesh(np.array([[-9, -9, 0], [9, -9, 0], [0, 9, 0.0]]), np.array([[0, 1, 2]]))
    stored = touches_of(mesh, levels={"qem_40": flat})
    assert (TOUCH_PERTURBATIONS["coarse_object"].apply(stored, 40.0, 0).images == 0).all()
    assert (TOUCH_PERTURBATIONS["coarse_object"].apply(stored, 100.0, 0).images != 0).any()


def test_an_object_with_another_axis_up_is_refused(mesh):
    with pytest.raises(ValueError, match="y up.* call rotate_to_z_up"):
        touches_of(replace(mesh, up="y"))


def test_rotations_turn_by_the_right_hand():
    assert np.allclose(rotations_about(np.array([0, 0, 1.0]), np.float64(90.0)) @ [1, 0, 0], [0, 1, 0])
