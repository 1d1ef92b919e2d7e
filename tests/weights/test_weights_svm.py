"""The SVM on pixels: what it can learn, what it cannot, and how folds of pixels flatter it."""

import numpy as np
import pytest
from sklearn.linear_model import LogisticRegression
from sklearn.svm import SVC

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.look.weights import svm
from haptic_glance.look.weights.svm import (
    SVMModel,
    balanced_rows,
    fit_svm,
    information_gains,
    pixel_samples,
    select_far_points,
)
from stages.weights.training import cross_validated, grouped_validated

CHANNELS = tuple("abcdef")
SHAPE = (45, 60)
R, C = np.mgrid[: SHAPE[0], : SHAPE[1]]
MASK = ((R - 22) ** 2 + (C - 30) ** 2) < 20**2


def draw(count=400, seed=0):
    return np.random.default_rng(seed).random((count, 3))


def band(features):
    """Salient in the middle of the first feature: no threshold and no linear weights find it."""
    return np.abs(features[:, 0] - 0.5) < 0.25


def uneven_xor(features):
    """Salient where one of two features is high, of which one more often is, so that one feature betrays a little."""
    return (features[:, 0] > 0.6) ^ (features[:, 1] > 0.7)


def smooth(seed):
    """A field of low waves in 0..1, like a map: pixels beside each other are alike."""
    waves = np.random.default_rng(seed).normal(size=(5, 4))
    field = sum(a * np.sin(b * R / 8 + c * C / 8 + 6 * d) for a, b, c, d in waves)
    return (field - field.min()) / np.ptp(field)


def spots(seed):
    """A ground truth map of four spots on the object."""
    pixels = np.argwhere(MASK)
    chosen = pixels[np.random.default_rng(seed).choice(len(pixels), 4, replace=False)]
    return np.max([np.exp(-((R - a) ** 2 + (C - b) ** 2) / 18) for a, b in chosen], axis=0) * MASK


def maps_of(seed):
    return {channel: smooth(100 * seed + k) * MASK for k, channel in enumerate(CHANNELS)}


@pytest.fixture(scope="module")
def model():
    return fit_svm(draw(), band(draw()), seed=0)


@pytest.mark.parametrize("rule", [band, uneven_xor])
def test_svm_learns_what_no_linear_weights_can(rule):
    features, fresh = draw(1500), draw(500, seed=1)
    predicted = fit_svm(features, rule(features), seed=0).predict(fresh) > 0.5
    linear = LogisticRegression(class_weight="balanced").fit(features, rule(features)).predict(fresh)
    assert (predicted == rule(fresh)).mean() > 0.88
    assert (linear == rule(fresh)).mean() < 0.75


def test_gains_choose_the_channel_that_tells_drop_a_constant_one_and_miss_an_exact_xor():
    """The thesis's remark on symmetry: on a compact shape it contributes nothing to the classifier (T3.2.3)."""
    features = draw()
    gains = fit_svm(features, features[:, 1] > 0.6, seed=0).gains
    assert gains.argmax() == 1 and gains[1] > 20 * gains[[0, 2]].max()
    constant = fit_svm(features * [1, 1, 0], band(features), seed=0)
    assert constant.gains[2] == 0
    np.testing.assert_array_equal(constant.predict(features), constant.predict(features * [1, 1, 0]))
    corners = np.array([[0, 0], [0, 1], [1, 0], [1, 1]] * 25, dtype=float)
    xor = fit_svm(corners, corners[:, 0] != corners[:, 1], seed=0)
    assert (xor.gains == 0).all() and (xor.predict(corners) == 0.5).all()


def test_information_gain_is_one_bit_for_a_giveaway_none_for_chance_and_sees_order_alone_from_either_side():
    values = draw(2000)[:, :1]
    assert information_gains(values, values[:, 0] > np.median(values)) == pytest.approx(1, abs=0.01)
    assert information_gains(values, np.arange(2000) % 2 == 0) < 0.01
    features, labels = draw().round(1), draw()[:, 0] > 0.85
    alone = [information_gains(column[:, None], labels)[0] for column in features.T]
    assert information_gains(features, labels) == pytest.approx(alone) and alone[0] > 0.2
    assert information_gains(-(features**3), labels) == pytest.approx(alone)
    for rare in (0.0, 1.0):
        values = np.where(np.arange(100) < 5, rare, 1 - rare)
        assert information_gains(values[:, None], values == rare) > 0.2


def test_classes_are_balanced_and_capped_by_the_seed():
    labels = np.arange(1000) % 10 == 0
    for max_rows, count in ((5000, 100), (60, 30)):
        rows = balanced_rows(labels, rng(0, "x"), max_rows)
        assert labels[rows].sum() == count and len(np.unique(rows)) == 2 * count
    assert len(fit_svm(draw(1000), labels, seed=0, max_rows=40).support) <= 40
    with pytest.raises(ValueError, match="max_rows must be at least 2"):
        fit_svm(draw(1000), labels, seed=0, max_rows=1)
    features = draw(1000)
    first, other, again = (
        fit_svm(features, band(features), seed=seed, max_rows=100).predict(features) for seed in (3, 4, 3)
    )
    assert not np.array_equal(first, other) and np.array_equal(first, again)


def test_prediction_is_that_of_the_library_in_any_steps(monkeypatch):
    features = draw()
    labels = band(features)
    features, labels = np.r_[features[labels][:150], features[~labels][:150]], np.repeat([True, False], 150)
    model = fit_svm(features, labels, seed=0)
    reference = SVC(gamma=float(model.gamma)).fit((features - model.center) * model.scale, labels)
    fresh = draw(50, seed=2)
    decision = reference.decision_function((fresh - model.center) * model.scale)
    for entries in (svm.ENTRIES, 7 * len(model.support)):
        monkeypatch.setattr(svm, "ENTRIES", entries)
        np.testing.assert_allclose(model.predict(fresh), (1 + np.tanh(decision)) / 2, atol=1e-9)
    assert model.predict(np.zeros((0, 3))).shape == (0,)


def test_model_comes_back_from_a_file_without_pickle(model, tmp_path):
    write_arrays(tmp_path / "model.npz", **model.to_arrays())
    again = SVMModel.from_arrays(read_arrays(tmp_path / "model.npz"))
    np.testing.assert_array_equal(again.predict(draw()), model.predict(draw()))
    with pytest.raises(ValueError, match="not an SVM model: center"):
        SVMModel.from_arrays({})


@pytest.mark.slow
def test_folds_of_pixels_flatter_where_neighbours_are_alike():
    views = [pixel_samples(maps_of(k), spots(k), 0, k, MASK, share=1) for k in range(4)]
    features, labels = (np.concatenate(parts) for parts in zip(*views, strict=True))
    groups = np.repeat(range(4), [len(view) for _, view in views])
    at_random = cross_validated(features, labels, seed=0)[0]  # spots lie anywhere: there is nothing to learn
    assert at_random > 0.7 and grouped_validated(features, labels, groups, seed=0)[0] < 0.6


def test_left_out_groups_cost_nothing_where_the_rule_holds_for_all_and_groups_of_one_class_are_left_out():
    features = draw(1000)
    labels, groups = band(features), np.arange(1000) % 4
    mean, deviation = grouped_validated(features, labels, groups, seed=0)
    assert mean == pytest.approx(cross_validated(features, labels, seed=0)[0], abs=0.05)
    assert 0 < deviation < 0.1
    features, labels, groups = features[:300], labels[:300].copy(), np.arange(300) % 3
    labels[groups == 2] = False
    kept = groups < 2
    scores = grouped_validated(features, labels, groups, seed=0)
    assert scores == grouped_validated(features[kept], labels[kept], groups[kept], seed=0)


def test_samples_are_balanced_a_third_and_their_own():
    maps, gts = maps_of(0), spots(0)
    features, labels = pixel_samples(maps, gts, 0, "cow 0")
    all_labels = pixel_samples(maps, gts, 0, "cow 0", share=1)[1]
    assert labels.sum() == np.ceil(0.3 * all_labels.sum()) == len(labels) / 2
    assert features.shape == (len(labels), 6)
    np.testing.assert_array_equal(pixel_samples(maps, gts, 0, "cow 0")[0], features)
    assert pixel_samples({"on": MASK.astype(float)}, gts, 0, "x", MASK)[0].min() >= 0.5  # of the object alone
    assert not np.array_equal(pixel_samples(maps, gts, 0, "cow 1")[0], features)
    features, labels = pixel_samples(maps, np.zeros(SHAPE), 0, "x")  # a view without salient pixels
    assert features.shape == (0, 6) and labels.shape == (0,) and labels.dtype == bool


def test_far_points_are_the_corners_and_then_the_middle():
    points = np.array([[0, 0], [1, 0], [0, 10], [5, 5], [10, 0], [10, 10], [0, 0]])
    assert select_far_points(points, 5).tolist() == [0, 5, 2, 4, 3]
    assert len(select_far_points(points)) == 6  # two are the same
    assert select_far_points(points[:0]).tolist() == select_far_points(points, 0).tolist() == []


@pytest.mark.parametrize(
    ("features", "labels", "message"),
    [
        (draw(), np.zeros(400, dtype=bool), "0 of 400 rows are salient"),
        (draw(), np.ones(400, dtype=bool), "400 of 400 rows are salient"),
        (draw(), np.ones(3, dtype=bool), "400 booleans"),
        (draw(), np.ones(400), "400 booleans"),
        (draw() * np.nan, np.ones(400, dtype=bool), "finite"),
    ],
)
def test_bad_rows_are_named(features, labels, message):
    for train in (fit_svm, cross_validated):
        with pytest.raises(ValueError, match=message):
            train(features, labels, seed=0)
