"""Series along a contour, their wavelets and three statistics."""

import numpy as np
import pytest
import pywt
from scipy import stats

from stages.sequences.contourlet import directional_std
from stages.sequences.series import CHANNELS, FEATURES, sequence_features, series


def named(values):
    """dict of name -> (n,) of features of series (n, frames, 19)."""
    return dict(zip(FEATURES, sequence_features(values).T, strict=True))


def walk(n=3, frames=25, seed=0):
    return np.random.default_rng(seed).normal(size=(n, frames, len(CHANNELS)))


def test_there_are_228_features_of_19_series():
    assert len(CHANNELS) == 19 and len(FEATURES) == 228 == sequence_features(walk()).shape[1]


def test_statistics_are_those_of_scipy_on_the_coefficients_of_pywt():
    values = walk()
    found = named(values)
    for k, channel in ((0, "direction0"), (17, "normal_y")):
        one = values[1, :, k]
        bands = dict(zip(("detail3", "detail2", "detail1"), pywt.wavedec(one, "db2", "symmetric", 3)[1:], strict=True))
        for band, numbers in {**bands, "sequence": one}.items():
            assert found[f"{channel}.{band}.rms"][1] == pytest.approx(np.sqrt(np.mean(numbers**2)))
            assert found[f"{channel}.{band}.std"][1] == pytest.approx(np.std(numbers))
            assert found[f"{channel}.{band}.skewness"][1] == pytest.approx(stats.skew(numbers))


@pytest.mark.parametrize("level", [0.0, 0.1, -1.0, 1e5])
def test_constant_series_have_no_spread_and_no_skewness(level):
    found = named(np.full((1, 25, 19), level))
    for name, (value,) in found.items():
        if name.endswith((".std", ".skewness")):
            assert value == 0
        elif ".sequence." in name:
            assert value == pytest.approx(abs(level))
        else:
            assert value == pytest.approx(0, abs=1e-9 * max(abs(level), 1))


def test_skewness_does_not_change_with_scale_and_turns_with_the_sign():
    values = walk()
    found, scaled, turned = named(values), named(1e-3 * values), named(-values)
    np.testing.assert_allclose(found["normal_x.detail1.skewness"], scaled["normal_x.detail1.skewness"])
    np.testing.assert_allclose(found["normal_x.detail1.skewness"], -turned["normal_x.detail1.skewness"])


@pytest.mark.parametrize("frames", [2, 4, 7, 13])
def test_short_series_have_finite_features(frames):
    assert np.isfinite(sequence_features(walk(frames=frames))).all()


def test_series_join_directions_and_normals_frame_by_frame():
    random = np.random.default_rng(1)
    images, normals = random.integers(0, 256, (2, 5, 16, 16), dtype=np.uint8), random.normal(size=(2, 5, 3))
    found = series(images, normals)
    assert found.shape == (2, 5, 19)
    np.testing.assert_array_equal(found[:, :, 16:], normals)
    for frame in range(5):
        np.testing.assert_allclose(found[:, frame, :16], directional_std(images[:, frame]), rtol=1e-5)


def test_bad_input_is_named():
    with pytest.raises(ValueError, match="normals"):
        series(np.zeros((2, 5, 16, 16)), np.zeros((2, 4, 3)))
    with pytest.raises(ValueError, match="2 frames"):
        sequence_features(np.zeros((2, 1, 19)))
    with pytest.raises(ValueError, match="NaN"):
        sequence_features(np.full((2, 25, 19), np.nan))
