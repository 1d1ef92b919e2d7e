"""The operators of the channels: N(.), pyramids, centre-surround (T eq. 3.1), the filled background."""

import numpy as np
import pytest

from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.look.channels import operators, printed
from haptic_glance.look.channels.channels import resize_map
from haptic_glance.look.channels.cropped_view import core, fill
from haptic_glance.look.channels.kernels import mean_of_other_maxima
from haptic_glance.look.channels.operators import PEAK, centre_surround, expand, normalise, pyramid

PAIRS = [(2, 5), (2, 6), (3, 6), (3, 7), (4, 7), (4, 8)]
EVERYWHERE = np.ones((9, 21), dtype=bool)


def peaks(places):
    values = np.zeros(EVERYWHERE.shape, dtype=np.float32)
    for place, height in places:
        values[place] = height
    return values


@pytest.mark.parametrize(
    ("places", "others"),
    [
        ([((4, 4), 5), ((4, 10), 2), ((4, 16), 1)], 0.3),
        ([((4, 10), 1), ((0, 0), 0.5), ((4, 16), 0.1)], 0.5),  # peaks at the border count, none under a tenth does
        ([((4, 4), 1), ((5, 5), 1)], 0),  # one peak, which touches itself at a corner
        ([((4, 4), 1), ((5, 5), 1), ((4, 16), 1)], 1),
        ([(np.s_[2:6, 3:9], 1)], 0),  # a plateau is one peak
    ],
)
def test_n_weighs_a_map_by_the_mean_of_its_other_maxima(places, others):
    values = peaks(places)
    scaled = values / values.max()
    assert mean_of_other_maxima(scaled, PEAK) == pytest.approx(others)
    for same in (values, 8 * values):
        np.testing.assert_allclose(normalise(same, EVERYWHERE), scaled * (1 - others) ** 2, atol=1e-6)


def test_n_is_zero_off_the_object_and_for_flat_or_missing_objects():
    cover = EVERYWHERE.copy()
    cover[:, 12:] = False
    values = peaks([((4, 4), 1), ((4, 16), 5)])
    assert normalise(values, cover)[4, 4] == 1 and not normalise(values, cover)[~cover].any()
    np.testing.assert_allclose(normalise(3 * values + 7, cover), normalise(values, cover), atol=1e-6)
    assert not normalise(np.full(cover.shape, 0.3, np.float32), EVERYWHERE).any()
    assert not normalise(values, np.zeros_like(cover)).any()


def test_pyramid_halves_nine_times_blurs_as_a_binomial_and_does_not_drift():
    slope = np.tile(np.linspace(0, 1, 600, dtype=np.float32), (450, 1))
    levels = pyramid(slope)
    assert [levels[s].shape for s in (0, 1, 4, 8)] == [(450, 600), (225, 300), (29, 38), (2, 3)]
    inner = slice(12, -12)
    np.testing.assert_allclose(expand(levels, 5, 3)[inner, inner], levels[3][inner, inner], atol=0.01)
    np.testing.assert_allclose(levels[2][50], slope[200, ::4], atol=4e-3)
    y, x = np.mgrid[:256, :256] - 128  # a blob of variance v keeps v / (v + (4^s - 1) / 3) of its height at scale s
    blob = pyramid(np.exp(-(y * y + x * x) / (2 * 60)).astype(np.float32))
    assert [blob[s].max() for s in (2, 3)] == pytest.approx([60 / 65, 60 / 81], abs=0.02)


def test_centre_surround_has_the_six_terms_of_equation_3_1(monkeypatch):
    terms = []
    monkeypatch.setattr(operators, "normalise", lambda values, *rest: terms.append(values) or normalise(values, *rest))
    levels = pyramid(np.random.default_rng(0).random((512, 512)).astype(np.float32))
    total = centre_surround(levels, {scale: np.ones(levels[scale].shape, dtype=bool) for scale in (2, 3, 4)})
    assert len(terms) == 6 and sorted(levels) == list(range(9)) and total.shape == (32, 32)
    for term, (c, s) in zip(terms, PAIRS, strict=True):
        np.testing.assert_array_equal(term, np.abs(levels[c] - expand(levels, s, c)))


def test_the_printed_formulas_find_red_amid_red_and_lose_a_single_peak():
    levels = pyramid(np.where(np.arange(512) < 256, 0.8, 0).astype(np.float32)[None].repeat(512, axis=0))
    as_printed, mended = (printed.centre_surround(levels, True, sign)[16] for sign in (-1, 1))
    assert as_printed[2] > 0.8 and mended[2] < 0.01  # far from the border of the red half
    values = peaks([((4, 4), 2)])
    assert not printed.normalise(values, mended=False).any() and printed.normalise(values, mended=True).max() == 1


def test_filling_keeps_the_known_and_continues_it_without_a_step():
    known = np.zeros((120, 120), dtype=bool)
    known[30:90, 30:90] = True
    image = np.random.default_rng(0).random((120, 120, 3)).astype(np.float32)
    np.testing.assert_array_equal(fill(image, known)[known], image[known])
    np.testing.assert_allclose(fill(image, known)[..., 1], fill(image[..., 1].copy(), known), atol=1e-6)
    np.testing.assert_allclose(fill(np.where(known, 0.7, 0).astype(np.float32), known), 0.7, rtol=1e-5)
    y, x = np.mgrid[:120, :120]
    assert np.abs(np.diff(fill(((x + y) / 240).astype(np.float32) * known, known), axis=1)).max() < 0.03
    assert not fill(np.ones((8, 8), np.float32), np.zeros((8, 8), bool)).any()


def test_the_core_of_a_mask_drops_its_rim_but_keeps_thin_parts():
    mask = np.zeros((100, 100), dtype=bool)
    mask[30:70, 30:70] = True
    mask[49:51, 70:95] = True
    kept = core(mask, 5)
    assert not kept[30:35, 40:60].any() and kept[36:64, 36:64].all()
    assert kept[49:51, 80:95].all()
    assert (kept <= mask).all()


@pytest.mark.parametrize(("shape", "scale"), [((17, 23), 2), ((450, 600), 4)])
def test_the_scale_of_a_map_is_known_by_its_size(shape, scale):
    sides = [-(-side // 2**scale) for side in shape]
    slope = resize_map(np.arange(sides[1], dtype=np.float32)[None].repeat(sides[0], axis=0), shape, (12, 16))[6]
    expected = ((np.arange(16) + 0.5) * shape[1] / 16 - 0.5) / 2**scale
    inner = (expected > 1) & (expected < sides[1] - 2)
    np.testing.assert_allclose(slope[inner], expected[inner], atol=0.15)


def test_the_weak_cache_computes_once_an_owner_and_lets_go():
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
