"""The operators: N(.), pyramids, centre-surround, the filled background."""

import numpy as np
import pytest

from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.look.channels.cropped_view import core, fill
from haptic_glance.look.channels.kernels import mean_of_other_maxima
from haptic_glance.look.channels.operators import PEAK, centre_surround, expand, normalise, pyramid

EVERYWHERE = np.ones((60, 80), dtype=bool)


def blobs(places, heights):
    y, x = np.mgrid[:60, :80]
    return sum(
        h * np.exp(-((y - r) ** 2 + (x - c) ** 2) / 18) for (r, c), h in zip(places, heights, strict=True)
    ).astype(np.float32)


GRID = [(r, c) for r in (10, 30, 50) for c in (10, 30, 50, 70)]


def test_one_peak_is_promoted_over_many_alike():
    assert normalise(blobs([(30, 40)], [1]), EVERYWHERE).max() == pytest.approx(1)
    assert normalise(blobs(GRID, [1] * 12), EVERYWHERE).max() < 0.01


def test_weight_is_the_squared_distance_to_the_mean_of_the_other_maxima():
    values = blobs([(20, 20), (40, 60)], [1.0, 0.4])
    assert mean_of_other_maxima(values / values.max(), PEAK) == pytest.approx(0.4, abs=0.01)
    assert normalise(values, EVERYWHERE).max() == pytest.approx(0.36, abs=0.01)


def test_a_plateau_is_one_peak():
    values = np.zeros((60, 80), dtype=np.float32)
    values[20:30, 20:40] = 1
    assert mean_of_other_maxima(values, PEAK) == 0


def test_n_ignores_scale_and_offset():
    values = blobs([(20, 20), (40, 60)], [1.0, 0.4])
    np.testing.assert_allclose(normalise(values, EVERYWHERE), normalise(3 * values + 7, EVERYWHERE), atol=1e-5)


def test_n_is_zero_off_the_object_and_for_flat_or_missing_objects():
    cover = EVERYWHERE.copy()
    cover[:, 40:] = False
    values = blobs([(30, 20), (30, 60)], [1.0, 5.0])
    assert (normalise(values, cover)[~cover] == 0).all()
    assert normalise(values, cover)[30, 20] == pytest.approx(1)
    assert not normalise(np.full((60, 80), 0.3, np.float32), EVERYWHERE).any()
    assert not normalise(values, np.zeros_like(cover)).any()


def test_pyramid_halves_nine_times_and_does_not_drift():
    slope = np.tile(np.linspace(0, 1, 1200, dtype=np.float32), (900, 1))
    levels = pyramid(slope)
    assert [levels[s].shape for s in (0, 1, 4, 8)] == [(900, 1200), (450, 600), (57, 75), (4, 5)]
    inner = slice(20, -20)
    np.testing.assert_allclose(expand(levels, 6, 3)[inner, inner], levels[3][inner, inner], atol=0.01)
    np.testing.assert_allclose(levels[2][50], slope[200, ::4], atol=2e-3)


def test_centre_surround_finds_a_dot_of_the_centre_scale():
    image = np.full((512, 512), 0.5, dtype=np.float32)
    image[250:266, 330:346] = 1
    levels = pyramid(image)
    cover = {s: np.ones(levels[s].shape, dtype=bool) for s in range(5)}
    found = centre_surround(levels, cover)
    assert found.shape == (32, 32)
    assert np.hypot(*(np.array(np.unravel_index(found.argmax(), found.shape)) * 16 - (258, 338))) < 16


def test_filling_keeps_the_known_and_continues_a_constant():
    known = np.zeros((70, 90), dtype=bool)
    known[20:50, 30:60] = True
    image = np.random.default_rng(0).random((70, 90)).astype(np.float32)
    np.testing.assert_array_equal(fill(image, known)[known], image[known])
    np.testing.assert_allclose(fill(np.where(known, 0.7, 0).astype(np.float32), known), 0.7, rtol=1e-5)


def test_filling_leaves_no_step():
    known = np.zeros((120, 120), dtype=bool)
    known[30:90, 30:90] = True
    y, x = np.mgrid[:120, :120]
    filled = fill(((x + y) / 240).astype(np.float32) * known, known)
    assert np.abs(np.diff(filled, axis=1)).max() < 0.03
    assert not fill(np.ones((8, 8), np.float32), np.zeros((8, 8), bool)).any()


def test_filling_works_on_three_planes_alike():
    known = np.zeros((40, 50), dtype=bool)
    known[10:30, 10:40] = True
    image = np.random.default_rng(1).random((40, 50, 3)).astype(np.float32)
    np.testing.assert_allclose(fill(image, known)[..., 1], fill(image[..., 1].copy(), known), atol=1e-6)


def test_the_core_of_a_mask_drops_its_rim_but_keeps_thin_parts():
    mask = np.zeros((100, 100), dtype=bool)
    mask[30:70, 30:70] = True
    mask[49:51, 70:95] = True
    kept = core(mask, 5)
    assert not kept[30:35, 40:60].any() and kept[36:64, 36:64].all()
    assert kept[49:51, 80:95].all()
    assert (kept <= mask).all()


def test_once_computes_once_an_owner_and_lets_go():
    class Owner:
        pass

    calls = []

    @weak_cache
    def double(owner, factor):
        calls.append(factor)
        return 2 * factor

    first, second = Owner(), Owner()
    assert [double(first, 1), double(first, 1), double(second, 1), double(first, 3)] == [2, 2, 2, 6]
    assert calls == [1, 1, 3]
    del first
    assert double(second, 1) == 2 and len(calls) == 3
