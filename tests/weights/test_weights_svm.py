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
    pixel_features,
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


def spots(seed, count=4):
    """A ground truth map of spots on the object."""
    pixels = np.argwhere(MASK)
    chosen = pixels[np.random.default_rng(seed).choice(len(pixels), count, replace=False)]
    return np.max([np.exp(-((R - a) ** 2 + (C - b) ** 2) / 18) for a, b in chosen], axis=0) * MASK


def maps_of(seed):
    return {channel: smooth(100 * seed + k) * MASK for k, channel in enumerate(CHANNELS)}


@pytest.mark.parametrize("rule", [band, uneven_xor])
def test_svm_learns_what_no_linear_weights_can(rule):
    features, fresh = draw(1500), draw(500, seed=1)
    found = fit_svm(features, rule(features), seed=0).predict(fresh) > 0.5
    linear = LogisticRegression(class_weight="balanced").fit(features, rule(features)).predict(fresh)
    assert (found == rule(fresh)).mean() > 0.88
    assert (linear == rule(fresh)).mean() < 0.75


def test_an_exact_xor_is_out_of_reach_of_information_gain():
    features = np.array([[0, 0], [0, 1], [1, 0], [1, 1]] * 25, dtype=float)
    model = fit_svm(features, features[:, 0] != features[:, 1], seed=0)
    assert (model.gains == 0).all() and (model.predict(features) == 0.5).all()


def test_the_channel_that_tells_has_the_highest_weight():
    features = draw()
    gains = fit_svm(features, features[:, 1] > 0.6, seed=0).gains
    assert gains.argmax() == 1 and gains[1] > 20 * gains[[0, 2]].max()


def test_a_constant_channel_has_no_gain_and_no_say():
    """The thesis's remark on symmetry: on a compact shape it contributes nothing to the classifier (T3.2.3)."""
    features = draw()
    features[:, 2] = 0.0
    model = fit_svm(features, band(features), seed=0)
    assert model.gains[2] == 0
    changed = features.copy()
    changed[:, 2] = 1.0
    np.testing.assert_array_equal(model.predict(changed), model.predict(features))


def test_information_gain_is_one_bit_for_a_giveaway_and_none_for_chance():
    values = draw(2000)[:, :1]
    assert information_gains(values, values[:, 0] > np.median(values)) == pytest.approx(1, abs=0.01)
    assert information_gains(values, np.arange(2000) % 2 == 0) < 0.01


def test_information_gain_sees_order_alone_from_either_side():
    values, labels = draw()[:, :1].round(1), draw()[:, 0] > 0.85
    assert information_gains(values, labels) == pytest.approx(information_gains(-(values**3), labels))


def test_the_gain_of_a_feature_does_not_depend_on_the_others():
    features, labels = draw().round(1), draw()[:, 0] > 0.85
    alone = [information_gains(column[:, None], labels)[0] for column in features.T]
    assert information_gains(features, labels) == pytest.approx(alone) and alone[0] > 0.2


@pytest.mark.parametrize("rare", [0.0, 1.0])
def test_information_gain_finds_a_rare_value(rare):
    values = np.where(np.arange(100) < 5, rare, 1 - rare)
    assert information_gains(values[:, None], values == rare) > 0.2


def test_classes_are_balanced_and_capped():
    labels = np.arange(1000) % 10 == 0
    for max_rows, count in ((5000, 100), (60, 30)):
        rows = balanced_rows(labels, rng(0, "x"), max_rows)
        assert labels[rows].sum() == count and len(np.unique(rows)) == 2 * count
    assert len(fit_svm(draw(1000), labels, seed=0, max_rows=40).support) <= 40


def test_prediction_is_that_of_the_library():
    features = draw()
    labels = band(features)
    features, labels = np.r_[features[labels][:150], features[~labels][:150]], np.repeat([True, False], 150)
    model = fit_svm(features, labels, seed=0)
    reference = SVC(gamma=float(model.gamma)).fit((features - model.center) * model.scale, labels)
    fresh = draw(50, seed=2)
    decision = reference.decision_function((fresh - model.center) * model.scale)
    np.testing.assert_allclose(model.predict(fresh), (1 + np.tanh(decision)) / 2, atol=1e-9)


def test_prediction_in_small_steps_is_the_same(monkeypatch):
    features = draw()
    model = fit_svm(features, band(features), seed=0)
    whole = model.predict(features)
    monkeypatch.setattr(svm, "ENTRIES", 7 * len(model.support))
    np.testing.assert_allclose(model.predict(features), whole, atol=1e-12)
    assert model.predict(np.zeros((0, 3))).shape == (0,)


def test_model_comes_back_from_a_file_without_pickle(tmp_path):
    features = draw()
    model = fit_svm(features, band(features), seed=0)
    write_arrays(tmp_path / "model.npz", **model.to_arrays())
    again = SVMModel.from_arrays(read_arrays(tmp_path / "model.npz"))
    np.testing.assert_array_equal(again.predict(features), model.predict(features))
    with pytest.raises(ValueError, match="not an SVM model: center"):
        SVMModel.from_arrays({})


def test_the_seed_decides_and_not_the_order_of_calls():
    features = draw(1000)
    one = fit_svm(features, band(features), seed=3, max_rows=100).predict(features)
    other = fit_svm(features, band(features), seed=4, max_rows=100).predict(features)
    assert not np.array_equal(one, other)
    np.testing.assert_array_equal(fit_svm(features, band(features), seed=3, max_rows=100).predict(features), one)


def view_rows(seeds):
    found = [pixel_samples(maps_of(k), spots(k), 0, k, MASK, share=1) for k in seeds]
    groups = np.repeat(seeds, [len(labels) for _, labels in found])
    return np.concatenate([f for f, _ in found]), np.concatenate([label for _, label in found]), groups


@pytest.mark.slow
def test_folds_of_pixels_flatter_where_neighbours_are_alike():
    features, labels, groups = view_rows(range(4))  # spots lie anywhere: there is nothing to learn
    at_random = cross_validated(features, labels, seed=0)[0]
    left_out = grouped_validated(features, labels, groups, seed=0)[0]
    assert at_random > 0.7 and left_out < 0.6


def test_left_out_groups_cost_nothing_where_the_rule_holds_for_all():
    features = draw(1200)
    mean, deviation = grouped_validated(features, band(features), np.arange(1200) % 4, seed=0)
    assert mean == pytest.approx(cross_validated(features, band(features), seed=0)[0], abs=0.05)
    assert 0 < deviation < 0.1


def test_a_map_of_the_object_alone_passes_for_accurate_against_the_background():
    maps = {"on the object": MASK.astype(float)}
    assert cross_validated(*pixel_samples(maps, spots(0), 0, "x", share=1), seed=0)[0] > 0.75
    on_object = pixel_samples(maps, spots(0), 0, "x", MASK, share=1)
    assert cross_validated(*on_object, seed=0)[0] < 0.6


def test_groups_of_one_class_are_left_out():
    features = draw(300)
    labels, groups = band(features), np.arange(300) % 3
    labels[groups == 2] = False
    kept = groups < 2
    both = (
        grouped_validated(features, labels, groups, seed=0),
        grouped_validated(features[kept], labels[kept], groups[kept], seed=0),
    )
    assert both[0] == both[1]
    with pytest.raises(ValueError, match="only 1 groups hold both"):
        grouped_validated(features, labels & (groups == 0), groups, seed=0)


def test_samples_are_balanced_a_third_and_their_own():
    maps, gts = maps_of(0), spots(0)
    features, labels = pixel_samples(maps, gts, 0, "cow 0")
    every = pixel_samples(maps, gts, 0, "cow 0", share=1)[1]
    assert labels.sum() == np.ceil(0.3 * every.sum()) == len(labels) / 2
    assert features.shape == (len(labels), 6)
    np.testing.assert_array_equal(pixel_samples(maps, gts, 0, "cow 0")[0], features)
    assert not np.array_equal(pixel_samples(maps, gts, 0, "cow 1")[0], features)


def test_samples_with_a_mask_are_of_the_object():
    maps = {"on": MASK.astype(float)}
    assert pixel_samples(maps, spots(0), 0, "x", MASK)[0].min() >= 0.5
    assert pixel_samples(maps, spots(0), 0, "x")[0].min() == 0


def test_a_view_without_salient_pixels_gives_no_rows():
    features, labels = pixel_samples(maps_of(0), np.zeros(SHAPE), 0, "x")
    assert features.shape == (0, 6) and labels.shape == (0,) and labels.dtype == bool


def test_every_map_becomes_a_column_of_200_by_200():
    features = pixel_features({"a": np.full(SHAPE, 0.25), "b": np.ones(SHAPE)})
    assert features.shape == (40000, 2)
    np.testing.assert_allclose(features, np.broadcast_to([0.25, 1], features.shape))


def test_far_points_are_the_corners_and_then_the_middle():
    points = np.array([[0, 0], [1, 0], [0, 10], [5, 5], [10, 0], [10, 10], [0, 0]])
    assert select_far_points(points, 5).tolist() == [0, 5, 2, 4, 3]
    assert len(select_far_points(points)) == 6  # two are the same
    assert select_far_points(points[:0]).tolist() == select_far_points(points, 0).tolist() == []


@pytest.mark.parametrize(
    ("features", "labels", "max_rows", "message"),
    [
        (draw(), np.zeros(400, dtype=bool), 100, "0 of 400 rows are salient"),
        (draw(), np.ones(400, dtype=bool), 100, "400 of 400 rows are salient"),
        (draw(), np.ones(3, dtype=bool), 100, "400 booleans"),
        (draw(), np.ones(400), 100, "400 booleans"),
        (draw() * np.nan, np.ones(400, dtype=bool), 100, "finite"),
        (draw(), np.ones(400, dtype=bool), 1, "max_rows"),
    ],
)
def test_bad_rows_are_named(features, labels, max_rows, message):
    for train in (fit_svm, cross_validated):
        with pytest.raises(ValueError, match=message):
            train(features, labels, seed=0, max_rows=max_rows)


def test_bad_questions_are_named():
    model = fit_svm(draw(), band(draw()), seed=0)
    with pytest.raises(ValueError, match="needs 3 features"):
        model.predict(np.zeros((5, 9)))
    with pytest.raises(ValueError, match="must agree"):
        pixel_samples(maps_of(0), spots(0)[:5], 0, "x")
    with pytest.raises(ValueError, match="share"):
        pixel_samples(maps_of(0), spots(0), 0, "x", share=0)
    with pytest.raises(ValueError, match="points must be finite"):
        select_far_points([[np.nan, 0]])
    with pytest.raises(ValueError, match="groups must have one group"):
        grouped_validated(draw(), band(draw()), np.zeros(3), seed=0)
    with pytest.raises(ValueError, match="too few"):
        cross_validated(draw(2), np.array([True, False]), seed=0)
