"""Samples of a surface: even, on the surface, free of noise, and what is read off them."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from haptic_glance.base.rng import rng
from haptic_glance.look.glance import COUNT, Samples, samples_of_mesh, samples_of_points
from haptic_glance.look.glance.draw import denoised
from haptic_glance.look.glance.features import relief
from haptic_glance.mesh.mesh import Mesh
from tests.shapes import ball_mesh, mesh_of

SPACING = np.sqrt(np.pi / COUNT)  # of points spread evenly over a sphere of radius 0.5


@pytest.fixture(scope="module")
def ball() -> Samples:
    return samples_of_mesh(ball_mesh(5, 0.5))


def test_samples_are_as_many_as_asked_for_even_and_on_the_surface(ball):
    assert len(ball.points) == pytest.approx(COUNT, rel=0.35)
    assert ball.areas.sum() == pytest.approx(ball_mesh(5, 0.5).face_areas.sum())
    assert np.linalg.norm(ball.points, axis=1) == pytest.approx(0.5, abs=0.2 * SPACING)
    assert np.einsum("ij,ij->i", ball.normals, ball.points) == pytest.approx(0.5, abs=0.01)
    polar = [np.sum(ball.areas[np.abs(ball.points[:, axis]) > 0.25]) for axis in range(3)]  # half of a sphere's area
    assert np.array(polar) == pytest.approx(ball.areas.sum() / 2, rel=0.02)
    assert ball.spacing == pytest.approx(SPACING, rel=0.25)


@pytest.mark.slow
def test_samples_hardly_depend_on_the_triangles_and_are_the_same_of_a_cloud_and_at_every_call(ball):
    coarse = samples_of_mesh(ball_mesh(4, 0.5))
    assert ball.tree.query(coarse.points)[0].max() < 2 * SPACING
    assert len(coarse.points) == pytest.approx(len(ball.points), rel=0.05)
    assert coarse.points.tobytes() == samples_of_mesh(ball_mesh(4, 0.5)).points.tobytes()
    dense = samples_of_mesh(ball_mesh(5, 0.5), 3 * COUNT)
    cloud = samples_of_points(dense.points, dense.normals)
    assert len(cloud.points) == pytest.approx(COUNT, rel=0.3)
    assert ball.tree.query(cloud.points)[0].max() < 2 * SPACING


def test_the_two_sides_of_a_thin_plate_stay_apart():
    plate = samples_of_mesh(mesh_of(trimesh.creation.box((0.7, 0.7, 0.001))))
    assert np.abs(np.abs(plate.normals[:, 2]) - 1).mean() < 0.05
    up = plate.average @ plate.normals[:, 2]
    inner = np.abs(plate.points[:, :2]).max(axis=1) < 0.3
    assert np.abs(up[inner]).min() > 0.99


def test_a_rim_between_two_sides_belongs_to_both_alike():
    plates = [trimesh.creation.box((0.7, 0.5, 0.001)).apply_translation([0, 0, z]) for z in (-0.2, 0.2)]
    samples = samples_of_mesh(mesh_of(trimesh.util.concatenate(plates)))
    up = samples.normals[:, 2]
    assert np.sort(up) == pytest.approx(-np.sort(up)[::-1], abs=1e-9)
    assert samples.areas[up > 0].sum() == pytest.approx(samples.areas[up < 0].sum(), abs=1e-12)


def test_little_surface_has_samples_along_it_and_none_is_an_error():
    needle = samples_of_mesh(Mesh(np.array([[-0.5, 0, 0], [0.5, 0, 0], [0, 1e-14, 0]]), np.array([[0, 1, 2]])))
    assert np.ptp(needle.points[:, 0]) > 0.9 and np.abs(needle.points[:, 1:]).max() < 1e-9
    with pytest.raises(ValueError, match="without area"):
        samples_of_mesh(Mesh(np.zeros((3, 3)), np.array([[0, 1, 2]])))
    with pytest.raises(ValueError, match="different places"):
        samples_of_points(np.zeros((9, 3)), np.tile([0.0, 0, 1], (9, 1)))
    with pytest.raises(ValueError, match="different places"):
        samples_of_points(np.zeros((1, 3)), np.array([[0.0, 0, 1]]))


def noisy(mesh: Mesh) -> Samples:
    moved = mesh.vertices + rng(0, "noise").normal(0, 0.005, mesh.vertices.shape)
    return samples_of_mesh(Mesh(moved, mesh.faces))


@pytest.mark.slow
def test_noise_changes_neither_the_area_nor_how_far_a_sphere_stands_out(ball):
    mesh = ball_mesh(6, 0.5)
    samples, surface = noisy(mesh), np.pi
    assert samples.rough and not ball.rough and denoised(ball) is ball  # a clean surface is left as it is
    assert samples.areas.sum() == pytest.approx(surface, rel=0.05)  # the noisy mesh itself has 1.9 times as much
    curvature, clean = relief(samples)[0] / samples.spacing, relief(ball)[0] / ball.spacing
    assert samples.shares @ curvature == pytest.approx(ball.shares @ clean, rel=0.1)
    alone = relief(replace(samples, rough=False))[0] / samples.spacing
    assert np.std(curvature) < 0.6 * np.std(alone)


def test_a_sheet_of_two_sides_is_not_taken_for_noise():
    """Of a doubled wall the normals of a cell cancel out as much as those of a rough surface."""
    inner, outer = trimesh.creation.icosphere(5, 0.495), trimesh.creation.icosphere(5, 0.5)
    inner.invert()
    samples = samples_of_mesh(mesh_of(trimesh.util.concatenate([inner, outer])))
    assert not samples.rough and samples.areas.sum() == pytest.approx(inner.area + outer.area)
