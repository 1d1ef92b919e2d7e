"""The operators of the channels: N(.), pyramids, centre-surround (T eq. 3.1), the filled background."""

import numpy as np
import pytest

from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.look.channels.channels import resize_map
from haptic_glance.look.channels.cropped_view import core, fill
from haptic_glance.look.channels.operators import normalise

EVERYWHERE = np.ones((9, 21), dtype=bool)


def peaks(places):
    values = np.zeros(EVERYWHERE.shape, dtype=np.float32)
    for place, height in places:
        values[place] = height
    return values


def test_n_is_zero_off_the_object_and_for_flat_or_missing_objects():
    cover = EVERYWHERE.copy()
    cover[:, 12:] = False
    values = peaks([((4, 4), 1), ((4, 16), 5)])
    assert normalise(values, cover)[4, 4] == 1 and not normalise(values, cover)[~cover].any()
    np.testing.assert_allclose(normalise(3 * values + 7, cover), normalise(values, cover), atol=1e-6)
    assert not normalise(np.full(cover.shape, 0.3, np.float32), EVERYWHERE).any()
    assert not normalise(values, np.zeros_like(cover)).any()


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
