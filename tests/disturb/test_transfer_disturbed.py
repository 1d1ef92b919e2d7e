"""Disturbed imprints."""

import numpy as np
import pytest

from haptic_glance.disturb.imprint import PERTURBATIONS, disturb

SLOPE = np.tile(np.linspace(0, 255, 32).astype(np.uint8), (3, 32, 1))
UNHARMED = {"noise": 0.0, "blur": 0.0, "dead_cells": 0.0, "occlusion": 0.0, "rotation": 0.0, "resolution": 32.0}


def felt(name, severity, seed=0, images=SLOPE):
    return disturb(images, name, severity, np.random.default_rng(seed))


@pytest.mark.parametrize("name", list(PERTURBATIONS))
def test_nothing_happens_at_the_severity_that_harms_nothing(name):
    assert np.allclose(felt(name, UNHARMED[name]), SLOPE / 255, atol=1e-6)


@pytest.mark.parametrize(
    ("name", "mild", "harsh"),
    [
        ("noise", 0.05, 0.2), ("blur", 1.0, 8.0), ("dead_cells", 0.05, 0.3), ("occlusion", 0.05, 0.4),
        ("rotation", 5.0, 60.0), ("resolution", 16.0, 4.0),
    ],
)  # fmt: skip
def test_a_harsher_severity_changes_more(name, mild, harsh):
    def lost(severity):
        found = felt(name, severity)
        step = 32 // found.shape[1]
        return np.abs(found.repeat(step, axis=1).repeat(step, axis=2) - SLOPE / 255).mean()

    assert 0 < lost(mild) < lost(harsh)


@pytest.mark.parametrize("name", list(PERTURBATIONS))
def test_the_same_draw_gives_the_same_imprints_in_range(name):
    harsh = {"resolution": 8.0, "rotation": 30.0, "blur": 3.0}.get(name, 0.3)
    one = felt(name, harsh)
    assert np.array_equal(one, felt(name, harsh))
    assert one.dtype == np.float32 and one.min() >= 0 and one.max() <= 1 and len(one) == 3


def test_what_is_occluded_feels_nothing_on_its_share_of_the_area():
    found = felt("occlusion", 0.25, images=np.zeros((5, 32, 32), np.uint8))
    assert (found.sum(axis=(1, 2)) == 16 * 16).all()
    assert len({tuple(np.argwhere(image == 1)[0]) for image in found}) > 1


def test_a_quarter_turn_is_that_of_the_array():
    image = felt("rotation", 90.0)[0]
    upright = np.tile(np.linspace(0, 1, 32)[:, None], (1, 32))
    assert min(np.abs(image - upright).max(), np.abs(image - upright[::-1]).max()) < 0.01


def test_a_coarse_array_reads_the_mean_of_the_cells_it_replaces():
    assert np.allclose(felt("resolution", 8.0)[0, 0], SLOPE[0, 0].reshape(8, 4).mean(axis=1) / 255, atol=1e-3)
