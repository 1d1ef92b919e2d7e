"""Denoisers on imprints of smooth shapes, whose clean values are known."""

import numpy as np
import pytest

from haptic_glance.touch import Skin
from stages.touch_stability.denoisers import DENOISERS


def domes(count, seed):
    """(count, 16, 16) f4 in 0..1: round domes at random places, of random size."""
    random, grid = np.random.default_rng(seed), np.mgrid[:16, :16]
    middle, width = random.uniform(4, 12, (2, count, 1, 1)), random.uniform(3, 8, (count, 1, 1))
    return (1 - np.exp(-((grid[0] - middle[0]) ** 2 + (grid[1] - middle[1]) ** 2) / width**2)).astype(np.float32)


def test_the_median_restores_single_dead_cells():
    flat = np.full((1, 16, 16), 0.5, dtype=np.float32)
    worn = flat.copy()
    worn[0, 3::4, 3::4] = 1
    assert np.array_equal(DENOISERS["median"](flat, 0)(worn), flat)


@pytest.fixture(scope="module")
def learned():
    """An autoencoder that learned from a hundred domes in a few passes."""
    autoencoder = pytest.importorskip("stages.touch_stability.autoencoder")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(autoencoder, "PASSES", 40)
        return autoencoder, DENOISERS["autoencoder"](domes(100, 0), 0)


@pytest.mark.slow
@pytest.mark.parametrize("fault", [{"noise": 0.2}, {"dead": 0.2}])
def test_the_autoencoder_brings_domes_that_it_never_felt_nearer_to_the_truth(learned, fault):
    clean = domes(40, 1)
    worn = Skin(**fault, seed=1)(clean, "domes")
    left, before = (float(((images - clean) ** 2).mean()) for images in (learned[1](worn), worn))
    assert left < 0.5 * before


@pytest.mark.slow
def test_what_it_learns_to_undo_varies_and_stays_within_the_range(learned, monkeypatch):
    module, clean = learned[0], domes(20, 2)
    monkeypatch.setattr(module, "UNDONE", {"dead": 0.3})
    dead = [float((module.disturbed(clean, np.random.default_rng(seed)) == 1).mean()) for seed in range(30)]
    assert 0.2 < max(dead) < 0.35 and min(dead) < 0.1


@pytest.mark.slow
def test_equal_seeds_give_equal_denoisers(learned, monkeypatch):
    monkeypatch.setattr(learned[0], "PASSES", 2)
    first, again, other = (DENOISERS["autoencoder"](domes(10, 0), seed)(domes(3, 1)) for seed in (0, 0, 1))
    assert np.array_equal(first, again) and not np.array_equal(first, other)
