"""The features of an imprint."""

import numpy as np
import pytest
import pywt

from haptic_glance.know import FEATURES, features
from haptic_glance.know.features import _halves

IMAGES = np.random.default_rng(0).random((5, 16, 16))


@pytest.mark.parametrize("size", [4, 5, 8, 21])
def test_halves_are_those_of_pywt_to_the_last_bit(size):
    images = np.random.default_rng(2).random((5, size, 9))
    for ours, expected in zip(_halves(images), pywt.dwt(images, "db2", "symmetric", axis=1), strict=True):
        assert np.array_equal(ours, expected)


def test_an_imprint_does_not_feel_its_neighbours_in_the_batch_and_none_has_no_features():
    assert len(set(FEATURES)) == len(FEATURES) == 41
    assert np.allclose(features(IMAGES)[3], features(IMAGES[3:4])[0])
    assert features(np.zeros((0, 16, 16))).shape == (0, 41)


@pytest.mark.parametrize("bad", [np.zeros((16, 16)), np.zeros((2, 7, 16)), np.full((1, 16, 16), np.nan)])
def test_what_is_no_stack_of_imprints_is_refused(bad):
    with pytest.raises(ValueError, match="images"):
        features(bad)
