"""The features of a glance on shapes whose heights, visibility, relief and symmetry are known."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.glance import FEATURES, samples_of_mesh, standardised
from haptic_glance.look.glance.cells import visibility
from haptic_glance.look.glance.features import features, fullness, relief
from haptic_glance.look.glance.mirror import symmetry
from haptic_glance.look.weights.weights import GLANCES

from .conftest import as_mesh


@pytest.fixture(scope="module")
def ball():
    return samples_of_mesh(as_mesh(trimesh.creation.icosphere(5, radius=0.5)))


def bowl():
    """A hemisphere with a thick wall, open at the top."""
    ball = trimesh.creation.icosphere(5, radius=0.5)
    inner = trimesh.creation.icosphere(5, radius=0.4)
    inner.invert()
    both = trimesh.util.concatenate([ball, inner])
    both.update_faces((both.triangles[:, :, 2] < 0.01).all(axis=1))
    return both


def box(size):
    return samples_of_mesh(as_mesh(trimesh.creation.box(size)))


def test_the_features_are_those_that_are_published(ball):
    assert list(features(ball)) == list(FEATURES) == list(GLANCES["glance"])
    assert set(GLANCES["glance_any_pose"]) < set(FEATURES)


def test_standardised_features_have_mean_zero_and_no_scaled_noise(ball):
    for name, values in standardised(ball).items():
        assert abs(values.mean()) < 0.1 and values.std() < 2.05, name
    for name in ("convexity", "relief", "distance", "seen", "off_plane"):
        assert standardised(ball)[name].std() < 0.7, name  # the same all over a sphere


def test_a_sphere_is_seen_from_half_of_all_directions(ball):
    seen, side, above, below = visibility(ball)
    assert seen == pytest.approx(0.5, abs=0.15) and seen.mean() == pytest.approx(0.5, abs=0.02)
    top, middle = ball.points[:, 2] > 0.45, np.abs(ball.points[:, 2]) < 0.05
    assert above[top].min() > below[top].max() and side[middle].mean() > 2 * side[top].mean()


def test_the_inside_of_a_bowl_is_seen_from_above_alone():
    samples = samples_of_mesh(as_mesh(bowl()))
    seen, _, above, below = visibility(samples)
    bottom = (np.linalg.norm(samples.points, axis=1) < 0.42) & (samples.points[:, 2] < -0.3)
    assert bottom.sum() > 50 and below[bottom].max() < 0.02 and above[bottom].min() > 0.15
    assert seen[bottom].mean() < seen[np.linalg.norm(samples.points, axis=1) > 0.48].mean()


def test_bumps_are_convex_dents_are_concave_and_flats_neither():
    samples = samples_of_mesh(as_mesh(bowl()))
    convexity, _, _ = relief(samples)
    radius = np.linalg.norm(samples.points, axis=1)
    inner, outer = (radius < 0.42) & (samples.points[:, 2] < -0.1), (radius > 0.49) & (samples.points[:, 2] < -0.1)
    assert convexity[inner].mean() < 0 < convexity[outer].mean()
    plate = box((0.7, 0.5, 0.2))
    flat = (np.abs(plate.points[:, 2]) > 0.099) & (np.abs(plate.points[:, :2]) < 0.15).all(axis=1)
    assert relief(plate)[0][flat] == pytest.approx(0, abs=0.02)


def test_a_thin_part_is_fuller_than_a_thick_one_and_a_tip_less():
    needle = samples_of_mesh(as_mesh(trimesh.creation.cylinder(0.02, 0.98)))
    ends = np.abs(needle.points[:, 2]) > 0.45
    assert fullness(needle, 0.12)[ends].mean() < fullness(needle, 0.12)[~ends].mean() - 0.3


def test_the_middle_is_between_top_and_bottom():
    upright = samples_of_mesh(as_mesh(trimesh.creation.cylinder(0.1, 0.9)))
    middle, height = features(upright)["middle"], np.abs(upright.points[:, 2])
    assert middle[height < 0.02].min() > 0.99 and middle[height > 0.44].max() < 0.3


def body():
    """A box with a head at one end, which has one upright mirror plane, y = 0."""
    head = trimesh.creation.icosphere(4, radius=0.15).apply_translation([0.3, 0, 0.3])
    return trimesh.util.concatenate([trimesh.creation.box((0.7, 0.3, 0.4)), head])


def test_the_mirror_plane_of_a_body_halves_it():
    samples = samples_of_mesh(as_mesh(body()))
    away, near = symmetry(samples)
    assert np.corrcoef(away, np.abs(samples.points[:, 1]))[0, 1] > 0.99 and away.max() > 0.05
    assert near[np.abs(samples.points[:, 1]) < 0.01].min() > 2 * near[np.abs(samples.points[:, 1]) > 0.1].max()


def test_both_mirror_planes_of_a_box_count_alike():
    samples = box((0.7, 0.4, 0.4))
    away, near = symmetry(samples)
    x, y = np.abs(samples.points[:, :2]).T
    assert near[(x < 0.01) & (y > 0.15)].mean() == pytest.approx(near[(y < 0.01) & (x > 0.3)].mean(), rel=0.1)
    assert away.max() > 0.02


def test_a_flat_top_has_one_rank():
    samples = box((0.7, 0.4, 0.4))
    rank = features(samples)["rank"]
    top = (samples.points[:, 2] > 0.199) & (samples.normals[:, 2] > 0.9)
    assert np.ptp(rank[top]) < 0.01 and rank[top].mean() > rank[~top].max() - 0.01


def test_no_feature_depends_on_the_turn_about_the_vertical(ball):
    turned = body().apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, [0, 0, 1]))
    one, other = (features(samples_of_mesh(as_mesh(mesh))) for mesh in (body(), turned))
    for name in FEATURES:
        assert one[name].mean() == pytest.approx(other[name].mean(), abs=max(0.3 * FEATURES[name], 1e-3)), name
