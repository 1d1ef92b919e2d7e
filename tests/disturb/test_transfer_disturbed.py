"""Disturbed imprints."""

import numpy as np
import pytest

from haptic_glance.disturb.imprint import PERTURBATIONS, disturb
from haptic_glance.disturb.picture import PICTURES, damage_pictures

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
