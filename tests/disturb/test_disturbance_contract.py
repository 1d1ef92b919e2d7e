"""Every disturbance of a touch, an imprint or a picture: none at its unharmed severity, more at a harsher one."""

import numpy as np
import pytest
import trimesh

from haptic_glance.disturb.imprint import PERTURBATIONS, disturb
from haptic_glance.disturb.picture import PICTURES, damage_pictures
from haptic_glance.disturb.touch_disturbances import TOUCH_PERTURBATIONS, Touches
from haptic_glance.mesh.mesh import Mesh

SLOPE = np.tile(np.linspace(0, 255, 32).astype(np.uint8), (3, 32, 1))
SEVERITIES = {  # that harms nothing, mild, harsh
    "noise": (0.0, 0.05, 0.2), "blur": (0.0, 1.0, 8.0), "dead_cells": (0.0, 0.05, 0.3), "occlusion": (0.0, 0.05, 0.4),
}  # fmt: skip


def felt(name, severity, images=SLOPE):
    return disturb(images, name, severity, np.random.default_rng(0))


@pytest.mark.parametrize("name", PERTURBATIONS)
def test_a_harsher_severity_changes_more_in_range_and_comes_again(name):
    unharmed, mild, harsh = SEVERITIES[name]

    def lost(severity):
        return np.abs(felt(name, severity) - SLOPE / 255).mean()

    assert np.allclose(felt(name, unharmed), SLOPE / 255, atol=1e-6) and 0 < lost(mild) < lost(harsh)
    images = felt(name, harsh)
    assert np.array_equal(images, felt(name, harsh))
    assert images.dtype == np.float32 and images.min() >= 0 and images.max() <= 1 and len(images) == 3


def test_an_occluded_square_feels_nothing_on_its_share_of_the_area():
    images = felt("occlusion", 0.25, images=np.zeros((5, 32, 32), np.uint8))
    assert (images.sum(axis=(1, 2)) == 16 * 16).all()
    assert len({tuple(np.argwhere(image == 1)[0]) for image in images}) > 1


@pytest.mark.parametrize("name", PERTURBATIONS)
def test_bytes_and_shares_are_the_same_imprints_and_a_severity_out_of_range_is_refused(name):
    severity = SEVERITIES[name][1]
    assert np.array_equal(felt(name, severity, SLOPE.astype(np.float32) / 255), felt(name, severity))
    assert felt(name, severity, SLOPE[:0]).shape[0] == 0
    for wrong in (-1.0, np.nan):
        with pytest.raises(ValueError, match="must (be|lie)"):
            felt(name, wrong)
    with pytest.raises(ValueError, match=r"bytes, or numbers in 0\.\.1"):
        felt(name, severity, SLOPE.astype(np.float32))
    with pytest.raises(ValueError, match="unknown disturbance 'noisy': choose one of"):
        felt("noisy", severity)


def test_an_array_that_is_not_square_loses_its_share_anywhere():
    images = felt("occlusion", 0.25, images=np.zeros((60, 8, 24), np.uint8))
    assert (images.sum(axis=(1, 2)) == 4 * 12).all()
    assert images.max(axis=(0, 1)).all() and images.max(axis=(0, 2)).all()


@pytest.mark.parametrize("name", PICTURES)
def test_a_picture_takes_shares_and_a_severity_in_range(name):
    pictures = np.random.default_rng(0).integers(0, 256, (2, 8, 8, 3)).astype(np.uint8)
    damaged = [damage_pictures(batch, name, 0.1, np.random.default_rng(0)) for batch in (pictures, pictures / 255)]
    assert np.allclose(*damaged, atol=1e-6)
    for wrong in (-1.0, np.nan):
        with pytest.raises(ValueError, match="must lie"):
            damage_pictures(pictures, name, wrong, np.random.default_rng(0))


DISTURBING = [name for name, known in TOUCH_PERTURBATIONS.items() if known.apply]
HARSH = {
    "localisation": 0.1, "sensor_turned": 45.0, "sensor_leaning": 20.0, "noise": 0.3, "dead_cells": 0.3, "gain": 0.5,
    "saturation": 0.5, "blur": 2.0, "hysteresis": 0.3, "object_turned": 45.0, "object_tilted": 45.0,
    "object_larger": 2.0, "object_smaller": 0.5, "coarse_object": 40.0, "coarse_object_soft": 40.0,
    "coarse_model": 40.0, "coarse_model_soft": 40.0,
}  # fmt: skip  # fmt: skip


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


@pytest.mark.parametrize("name", DISTURBING)
def test_a_harsh_severity_changes_what_the_registry_says_and_the_unharmed_one_nothing(touches, name):
    known = TOUCH_PERTURBATIONS[name]
    calm = known.apply(touches, known.unharmed, 0)
    assert np.allclose(calm.images, touches.images, atol=1e-3)
    assert calm.positions is None or np.allclose(calm.positions, touches.positions, atol=1e-9)
    first, again, other = (known.apply(touches, HARSH[name], draw) for draw in (0, 0, 1))
    change = np.abs(first.images - touches.images).mean()
    moved = 0 if first.positions is None else np.abs(first.positions - touches.positions).max()
    assert max(change, moved) > 0.01 and first.images.shape == touches.images.shape
    assert first.images.min() >= 0 and first.images.max() <= 1
    assert (first.positions is not None) == known.moves_positions
    assert np.array_equal(first.images, again.images)
    assert np.array_equal(first.images, other.images) != known.random_draws


@pytest.mark.parametrize("name", [name for name in DISTURBING if TOUCH_PERTURBATIONS[name].random_draws])
def test_a_random_disturbance_depends_on_the_seed(mesh, name):
    ours, theirs = (TOUCH_PERTURBATIONS[name].apply(touches_of(mesh, seed=seed), HARSH[name], 0) for seed in (0, 1))
    assert not np.array_equal(ours.images, theirs.images)


@pytest.mark.parametrize(
    ("name", "severity"), [("localisation", -0.1), ("sensor_turned", 200.0), ("noise", -1.0), ("object_larger", 0.0)]
)
def test_severities_out_of_range_are_refused(touches, name, severity):
    with pytest.raises(ValueError, match="must"):
        TOUCH_PERTURBATIONS[name].apply(touches, severity, 0)
