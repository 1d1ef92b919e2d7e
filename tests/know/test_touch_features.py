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


def named(images):
    """dict of feature -> (n,) of images (n, rows, columns)."""
    return dict(zip(FEATURES, features(images).T, strict=True))


@pytest.mark.parametrize("shape", [(16, 16), (32, 32), (9, 21)])
def test_wavelet_features_agree_with_a_plain_three_level_decomposition(shape):
    image = np.random.default_rng(1).random(shape)
    ours = named(image[None])
    with pytest.warns(UserWarning) if min(shape) < 24 else np.errstate():  # pywt warns of borders on small images
        levels = pywt.wavedec2(image, "db2", mode="symmetric", level=3)[:0:-1]
    for level, details in enumerate(levels, start=1):
        for band, c in zip("hvd", details, strict=True):
            c = c.ravel()
            expected = {"norm": np.sqrt((c**2).sum()), "mean": c.mean(), "std": c.std(), "entropy": entropy(c**2)}
            for name, value in expected.items():
                assert ours[f"{band}{level}_{name}"][0] == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize("size", [4, 5, 8, 21])
def test_halves_are_those_of_pywt_to_the_last_bit(size):
    images = np.random.default_rng(2).random((5, size, 9))
    for ours, expected in zip(_halves(images), pywt.dwt(images, "db2", "symmetric", axis=1), strict=True):
        assert np.array_equal(ours, expected)


def test_components_are_those_of_scikit_learn_to_the_last_bit():
    random = np.random.default_rng(3)
    known, new = random.random((300, 41)) * np.geomspace(1e-9, 9, 41), random.random((7, 41))
    known[:, 5] = 0.1  # has no scale but rounding
    expected, ours = make_pipeline(*reduction()).fit(known), Components(known)
    for samples in (known, new, new[:1]):
        assert np.array_equal(ours.transform(samples), expected.transform(samples))


@pytest.mark.parametrize("value", [0.0, 1.0])
def test_even_imprint_has_no_detail_and_its_mass_in_the_middle(value):
    ours = {name: float(one[0]) for name, one in named(np.full((1, 16, 16), value)).items()}
    assert ours.pop("max") == ours.pop("mean") == value
    assert ours.pop("centre_row") == pytest.approx(0.5) and ours.pop("centre_column") == pytest.approx(0.5)
    assert all(abs(rest) < 1e-12 for name, rest in ours.items() if "entropy" not in name)
    assert np.isfinite(list(ours.values())).all()


def test_edges_across_rows_are_horizontal_detail_alone():
    ours = named(np.repeat(np.random.default_rng(2).random(16)[:, None], 16, axis=1)[None])
    assert ours["h1_norm"] > 0.1 and ours["v1_norm"] < 1e-9 and ours["d1_norm"] < 1e-9


def test_centre_of_mass_is_the_one_pressed_cell():
    image = np.zeros((1, 16, 16))
    image[0, 3, 15] = 0.7
    assert named(image)["centre_row"] == pytest.approx(3 / 15) and named(image)["centre_column"] == 1.0


def test_an_imprint_does_not_feel_its_neighbours_in_the_batch_and_none_has_no_features():
    assert len(set(FEATURES)) == len(FEATURES) == 41
    assert np.allclose(features(IMAGES)[3], features(IMAGES[3:4])[0])
    assert features(np.zeros((0, 16, 16))).shape == (0, 41)


@pytest.mark.parametrize("bad", [np.zeros((16, 16)), np.zeros((2, 7, 16)), np.full((1, 16, 16), np.nan)])
def test_what_is_no_stack_of_imprints_is_refused(bad):
    with pytest.raises(ValueError, match="images"):
        features(bad)
