"""The features of an imprint."""

import numpy as np
import pytest
import pywt
from scipy.stats import entropy
from sklearn.pipeline import make_pipeline

from haptic_glance.know import FEATURES, features
from haptic_glance.know.classifiers import reduction
from haptic_glance.know.components import Components
from haptic_glance.know.features import _halves

IMAGES = np.random.default_rng(0).random((5, 16, 16))


def column(values, name):
    return values[:, FEATURES.index(name)]


def test_there_are_forty_one_each_with_its_own_name():
    assert features(IMAGES).shape == (5, 41) and len(set(FEATURES)) == len(FEATURES) == 41


@pytest.mark.parametrize("shape", [(16, 16), (32, 32), (9, 21)])
def test_wavelet_features_agree_with_a_plain_three_level_decomposition(shape):
    image = np.random.default_rng(1).random(shape)
    found = features(image[None])
    with pytest.warns(UserWarning) if min(shape) < 24 else np.errstate():  # pywt warns of borders on small images
        levels = pywt.wavedec2(image, "db2", mode="symmetric", level=3)[:0:-1]
    for level, details in enumerate(levels, start=1):
        for band, c in zip("hvd", details, strict=True):
            c = c.ravel()
            expected = {"norm": np.sqrt((c**2).sum()), "mean": c.mean(), "std": c.std(), "entropy": entropy(c**2)}
            for name, value in expected.items():
                assert column(found, f"{band}{level}_{name}")[0] == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize("size", [4, 5, 8, 9, 16, 21])
def test_halves_are_those_of_pywt_to_the_last_bit(size):
    images = np.random.default_rng(2).random((5, size, 9))
    for found, expected in zip(_halves(images), pywt.dwt(images, "db2", "symmetric", axis=1), strict=True):
        assert np.array_equal(found, expected)


def test_components_are_those_of_scikit_learn_to_the_last_bit():
    random = np.random.default_rng(3)
    known, new = random.random((300, 41)) * np.geomspace(1e-9, 9, 41), random.random((7, 41))
    known[:, 5] = 0.1  # has no scale but rounding
    expected, found = make_pipeline(*reduction()).fit(known), Components(known)
    for samples in (known, new, new[:1]):
        assert np.array_equal(found.transform(samples), expected.transform(samples))


@pytest.mark.parametrize("value", [0.0, 1.0])
def test_even_imprint_has_no_detail_and_its_mass_in_the_middle(value):
    found = dict(zip(FEATURES, features(np.full((1, 16, 16), value))[0], strict=True))
    assert found.pop("max") == found.pop("mean") == value
    assert found.pop("centre_row") == pytest.approx(0.5) and found.pop("centre_column") == pytest.approx(0.5)
    assert all(abs(rest) < 1e-12 for name, rest in found.items() if "entropy" not in name)
    assert np.isfinite(list(found.values())).all()


def test_edges_across_rows_are_horizontal_detail_alone():
    stripes = np.repeat(np.random.default_rng(2).random(16)[:, None], 16, axis=1)[None]
    found = features(stripes)
    assert column(found, "h1_norm") > 0.1 and column(found, "v1_norm") < 1e-9 and column(found, "d1_norm") < 1e-9


def test_transposing_swaps_horizontal_and_vertical():
    here, there = features(IMAGES), features(IMAGES.transpose(0, 2, 1))
    for name in ("1_norm", "2_mean", "3_entropy"):
        assert np.allclose(column(here, f"h{name}"), column(there, f"v{name}"))
    assert np.allclose(column(here, "centre_row"), column(there, "centre_column"))


def test_centre_of_mass_is_the_one_pressed_cell():
    image = np.zeros((1, 16, 16))
    image[0, 3, 15] = 0.7
    found = features(image)
    assert column(found, "centre_row") == pytest.approx(3 / 15) and column(found, "centre_column") == 1.0


def test_an_imprint_does_not_feel_its_neighbours_in_the_batch():
    assert np.allclose(features(IMAGES)[3], features(IMAGES[3:4])[0])


def test_no_imprints_have_no_features():
    assert features(np.zeros((0, 16, 16))).shape == (0, 41)


@pytest.mark.parametrize("bad", [np.zeros((16, 16)), np.zeros((2, 7, 16)), np.full((1, 16, 16), np.nan)])
def test_what_is_no_stack_of_imprints_is_refused(bad):
    with pytest.raises(ValueError, match="images"):
        features(bad)
