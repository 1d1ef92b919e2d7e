"""Exploring by touch on objects whose likelihoods are known."""

import sys

import numpy as np
import pytest

from haptic_glance.know import (
    LIKELIHOODS,
    SPLITS,
    STRATEGIES,
    Calibration,
    Trial,
    calibrate,
    explore,
    split_touches,
    stop,
)
from haptic_glance.know.belief import calibrate_to_stop, feature_kernel, log_likelihood, place_kernel

PLAIN = Calibration(1.0, 0.0)
TELLING = np.array([[0.3, 0.0], [2.0, 0.0], [0.5, 0.0]])  # log likelihoods of two objects at three places


def random(seed=0):
    return np.random.default_rng(seed)


def touch(strategy, observed, most, seed=0):
    """Beliefs in two objects with the same places: log likelihoods (places, 2), foreseen just as they will be felt."""
    observed = np.stack([observed, observed[:, ::-1]])
    predicted = np.stack([observed[0], observed[1]], axis=1)  # (places, hypotheses, classes)
    predicted = np.repeat(predicted[None, :, :, None], 2, axis=0)
    return explore(strategy, observed, predicted, np.ones((2, len(observed[0]), 2, 1)), PLAIN, most, random(seed))


@pytest.mark.parametrize(("strategy", "order"), [("saliency", [0.3, 2.0, 0.5]), ("gain", [2.0, 0.5, 0.3])])
def test_saliency_touches_in_the_order_of_the_points_and_gain_the_telling_place_first(strategy, order):
    beliefs = touch(strategy, TELLING, 3)
    assert np.allclose(beliefs[0, :, 0] - beliefs[0, :, 1], np.cumsum(order))


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_no_place_is_touched_twice(strategy):
    values = np.array([[1.0, 0.0], [20.0, 0.0], [300.0, 0.0], [4000.0, 0.0]])  # any sum tells its parts
    last = touch(strategy, values, 4)[:, -1]
    assert np.allclose(last[:, 0] - last[:, 1], [4321, -4321])


def test_random_orders_differ_and_come_again_with_the_generator():
    values = np.stack([np.arange(9.0), np.zeros(9)], axis=1)
    first, again, other = (touch("random", values, 9, seed) for seed in (1, 1, 2))
    assert np.array_equal(first, again) and not np.allclose(first, other)


def test_stopping_waits_for_the_confidence_and_no_longer():
    beliefs = np.log([[[0.5, 0.5], [0.9, 0.1], [0.99, 0.01]], [[0.5, 0.5], [0.4, 0.6], [0.3, 0.7]]])
    touches, belief, right = stop(beliefs, np.array([0, 0]), 0.9)
    assert touches.tolist() == [2, 3] and right.tolist() == [True, False]
    assert np.allclose(belief, [0.9, 0.7])


def gaussian_touches(shared, count=4000, touches=6):
    """Log likelihoods of touches of two objects at -1 and 1 in noise, a part of which all touches of one share."""
    generator, truth = random(), np.arange(count) % 2
    noise = np.sqrt(1 - shared) * generator.standard_normal((count, touches))
    noise += np.sqrt(shared) * generator.standard_normal((count, 1))
    value = 2 * truth[:, None] - 1 + noise
    return np.stack([-((value + 1) ** 2) / 2, -((value - 1) ** 2) / 2], axis=2), truth


def test_independent_touches_add_up_and_shared_ones_are_redundant():
    calibration = calibrate(*gaussian_touches(0.0))
    assert calibration.weight == pytest.approx(1, abs=0.1) and calibration.redundancy == pytest.approx(0, abs=0.05)
    assert calibrate(*gaussian_touches(0.95)).redundancy > 0.8
    sequences, truth = gaussian_touches(0.3, 40)
    assert calibrate(sequences.tolist(), truth.tolist()) == calibrate(sequences, truth)


def test_the_plain_product_is_overconfident_where_touches_share_and_the_calibrated_belief_is_not():
    sequences, truth = gaussian_touches(0.6)
    learn, check = slice(0, 2000), slice(2000, None)
    gaps = {}
    for redundancy in (True, False):
        calibration = calibrate(sequences[learn], truth[learn], redundancy)
        belief = np.exp(calibration.log_belief(sequences[check].sum(axis=1), 6))
        assert np.allclose(belief.sum(axis=1), 1)
        gaps[redundancy] = belief.max(axis=1).mean() - (belief.argmax(axis=1) == truth[check]).mean()
    assert abs(gaps[True]) < 0.02 and gaps[False] > 0.05


@pytest.mark.parametrize(("right", "kept"), [(280, True), (274, False)])  # 285 asked, less 7.5 for chance
def test_chance_alone_changes_no_calibration(right, kept):
    truth = (np.arange(300) >= right).astype(int)
    sequences = np.tile([[[4.0, 0.0]]], (300, 1, 1))  # one touch that says the first object
    assert (calibrate_to_stop(sequences, truth, 0.95, PLAIN) is PLAIN) == kept


def test_a_belief_that_ends_the_touching_is_as_right_as_it_says_where_it_was_not():
    random, truth = np.random.default_rng(0), np.repeat([0, 1], 150)
    signs = np.where(truth == 0, 1.0, -1.0)[:, None, None] * [1.0, -1.0]
    honest = 0.5 * signs + 0.7 * random.normal(size=(300, 20, 1)) * [1.0, -1.0]
    assert calibrate_to_stop(honest, truth, 0.95, PLAIN) is PLAIN
    misled = np.where((random.random(300) < 0.2)[:, None] & (np.arange(20) < 3), -6.0, 1.0)  # at first, then no more
    sequences = honest + misled[..., None] * signs

    def answers(calibration):
        belief = np.exp(calibration.log_belief(sequences.cumsum(axis=1), np.arange(1, 21)))
        rows, first = np.arange(300), (belief.max(axis=2) >= 0.95).argmax(axis=1)
        named = belief[rows, first].max(axis=1) >= 0.95
        return named.mean(), (belief[rows, first].argmax(axis=1) == truth)[named].mean()

    assert answers(PLAIN)[1] < 0.85
    named, right = answers(calibrate_to_stop(sequences, truth, 0.95, PLAIN))
    assert named > 0.5 and right >= 0.95
    noise = random.normal(size=(300, 20, 2))  # names no object
    quiet = calibrate_to_stop(noise, truth, 0.95, Calibration(2.0, 0.0))
    assert np.exp(quiet.log_belief(noise.cumsum(axis=1), np.arange(1, 21))).max() < 0.95


@pytest.mark.parametrize("change, words", [
    (lambda x, t: (np.where(x == 0, np.nan, x), t), "sequences must be finite log likelihoods, got nan in sequence 0"),
    (lambda x, t: (x - np.inf, t), "sequences must be finite log likelihoods, got -inf"),
    (lambda x, t: (x[:0], t[:0]), r"sequences must .* of each at least one, got shape \(0, 3, 2\)"),
    (lambda x, t: (x[..., :0], t), r"sequences must .* got shape \(4, 3, 0\)"),
    (lambda x, t: (x[0], t), r"sequences must .* got shape \(3, 2\)"),
    (lambda x, t: (x, t[:2]), r"truth must hold one class from 0 to 1 for each of the 4 sequences"),
    (lambda x, t: (x, t + 1), "truth must hold one class from 0 to 1"),
    (lambda x, t: (x, t - 1), "truth must hold one class from 0 to 1"),
    (lambda x, t: (x, t * np.nan), "truth must hold one class from 0 to 1"),
])  # fmt: skip
def test_touches_that_calibrate_nothing_are_named(change, words):
    with pytest.raises(ValueError, match=words):
        calibrate(*change(np.zeros((4, 3, 2)), np.array([0, 1, 0, 1])))


@pytest.mark.parametrize("split", SPLITS)
def test_hold_out_takes_a_quarter_and_shares_nothing_and_regions_keep_their_distance(split):
    truth, places = np.repeat([0, 1], 40), random().uniform(-0.5, 0.5, (80, 3))
    train, test = split_touches(truth, places, split, 0.3, random())
    assert not set(train) & set(test) and np.bincount(truth[test]).tolist() == [10, 10]
    for label in (0, 1):
        known, unknown = places[train[truth[train] == label]], places[test[truth[test] == label]]
        apart = np.linalg.norm(known[:, None] - unknown[None], axis=2).min()
        assert apart > 0.3 if split == "regions" else len(known) == 30


def test_hold_out_refuses_objects_with_too_few_touches():
    with pytest.raises(ValueError, match="too few touches"):
        split_touches(np.zeros(10, dtype=int), np.zeros((10, 3)), "regions", 0.1, random())
    with pytest.raises(ValueError, match="unknown split sideways"):
        split_touches(np.zeros(10, dtype=int), np.zeros((10, 3)), "sideways", 0.1, random())


def test_likelihood_is_the_mean_kernel_of_an_objects_touches():
    kernel, truth = np.array([[0.2, 0.4, 0.9]]), np.array([0, 0, 1])
    assert np.allclose(np.exp(log_likelihood(kernel, truth)), [[0.3, 0.9]])
    counted = log_likelihood(kernel * [1, 0, 1], truth, np.array([[1, 1]]))
    assert np.allclose(np.exp(counted), [[0.2, 0.9]])


@pytest.mark.parametrize("kernel", [feature_kernel, place_kernel])
def test_kernels_are_one_at_no_distance_and_fall(kernel):
    values = kernel(np.zeros((1, 3)), np.array([[0, 0, 0], [0.1, 0, 0], [1, 0, 0]]))[0]
    assert values[0] == 1 and values[0] > values[1] > values[2] > 0


def trial(likelihood="imprint", split="random", tell=3.0):
    """Two objects of 40 touches: the half with x > 0 feels unlike, by `tell`, the other half the same."""
    generator = random()
    truth, places = np.repeat([0, 1], 40), generator.uniform(-0.5, 0.5, (80, 3))
    samples = generator.standard_normal((80, 2)) * 0.3
    samples[:, 0] += tell * truth * (places[:, 0] > 0)
    train, test = split_touches(truth, places, split, 0.1, random())
    return Trial(samples, places, truth, train, test, likelihood, split, 0.1, random()), places[test].reshape(2, -1, 3)


@pytest.mark.parametrize("split", SPLITS)
@pytest.mark.parametrize("likelihood", LIKELIHOODS)
def test_a_trial_gives_whole_finite_numbers(likelihood, split):
    case, places = trial(likelihood, split)
    count = places.shape[1]
    assert case.observed.shape == (2, count, 2) and case.predicted.shape[:3] == (2, count, 2)
    assert all(np.isfinite(values).all() for values in (case.observed, case.predicted, case.probabilities))
    assert np.allclose(case.probabilities.sum(axis=3), 1) and case.truth.tolist() == [0, 1]


@pytest.mark.parametrize("likelihood", ["imprint", "imprint_place"])
def test_gain_looks_where_the_objects_differ(likelihood):
    case, places = trial(likelihood)
    first = explore("gain", case.observed, case.predicted, case.probabilities, case.calibration, 1, random())
    first = np.exp(first)[[0, 1], 0, [0, 1]]
    alike = np.exp(case.calibration.log_belief(case.observed, 1))[[0, 1], :, [0, 1]][places[:, :, 0] < 0]
    assert 0.3 < (places[:, :, 0] > 0).mean() < 0.7 and first.min() > 0.7 and first.min() > np.median(alike)


@pytest.mark.parametrize("at_once", [1, 40, 10**6])
def test_places_are_weighed_alike_however_many_at_once(at_once, monkeypatch):
    generator = random()
    observed, predicted = generator.normal(size=(2, 7, 3)), generator.normal(size=(2, 7, 3, 4, 3))
    given = (observed, predicted, np.full((2, 7, 3, 4), 1 / 4), Calibration(1.0, 0.5), 5)
    beliefs = explore("gain", *given, random())
    monkeypatch.setattr(sys.modules[explore.__module__], "AT_ONCE", at_once)
    assert np.array_equal(explore("gain", *given, random()), beliefs)


def test_no_difference_leaves_the_belief_near_even():
    case, _ = trial(tell=0.0)
    beliefs = explore("gain", case.observed, case.predicted, case.probabilities, case.calibration, 10, random())
    assert np.exp(beliefs).max() < 0.9
