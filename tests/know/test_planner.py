"""The expected entropy of the name, and draws from a belief, beside their literal formulas."""

import numpy as np
import pytest

from haptic_glance.know.likelihood import Likelihood
from haptic_glance.know.planner import draw, expected_entropy
from haptic_glance.know.pressure_array import PressureArray


def test_the_expected_entropy_is_its_formula():
    random = np.random.default_rng(0)
    names, shares = np.array([4, 1, 4, 2, 1]), random.dirichlet(np.ones(5))
    truths, truth_shares = np.array([0, 3]), np.array([0.25, 0.75])
    evidence = random.normal(size=(3, 2, 5))
    expected = np.zeros(3)
    for line in range(3):
        for truth in range(2):
            weights = shares * np.exp(evidence[line, truth])
            of_name = np.array([weights[names == name].sum() for name in (1, 2, 4)]) / weights.sum()
            expected[line] -= truth_shares[truth] * (of_name * np.log(of_name)).sum()
    assert expected_entropy(names, shares, truths, truth_shares, evidence) == pytest.approx(expected, abs=1e-9)


def test_draws_follow_the_weights_and_an_id_occurs_once():
    weights = np.array([0.0, 3.0, 1.0, 0.0, 4.0])
    ids, shares = draw(weights, 800, np.random.default_rng(0))
    assert ids.tolist() == [1, 2, 4] and shares == pytest.approx([3 / 8, 1 / 8, 4 / 8], abs=2e-3)
    first = [draw(weights, 1, np.random.default_rng(seed))[0][0] for seed in range(400)]
    assert np.bincount(first, minlength=5) / 400 == pytest.approx(weights / 8, abs=0.08)


def test_a_touch_counts_less_the_nearer_it_is_to_others():
    model = Likelihood(repeated=0.7, repeated_anywhere=0.2, repeated_within=0.3)
    assert model.weight(np.zeros(0)) == 1
    assert model.weight(np.zeros(1)) == pytest.approx(1 / 1.7) and model.weight(np.full(1, 9.0)) == pytest.approx(
        1 / 1.2
    )
    near = 0.2 + 0.5 * np.exp(-1)
    assert model.weight(np.array([[0.3, 9.0]])) == pytest.approx([1 / (1 + near + 0.2)])


def test_a_touch_that_fits_loses_nothing_and_one_that_went_astray_loses_no_more_than_that():
    model = Likelihood(travel=2.0, travel_scale=0.1, relief=3.0, relief_scale=0.2, astray=50.0)
    assert model.of_touch(np.zeros(1), np.zeros(1)) == pytest.approx(0, abs=1e-9)
    expected = -2 * np.log(1 + (0.3 / 0.1) ** 2) - 3 * np.log(1 + 0.08 / 0.2**2)
    assert model.of_touch(np.array([0.3]), np.array([0.08])) == pytest.approx(expected, abs=1e-6)
    assert Likelihood(astray=5.0).of_touch(np.array([9.0]), np.ones(1)) == pytest.approx(-5)


def test_noise_widens_the_scales():
    noisy = Likelihood(travel_scale=0.03, relief_scale=0.1).with_noise(PressureArray((2, 2), 1, 0.5, 0.04, 0.1))
    assert noisy.travel_scale == pytest.approx(0.05) and noisy.relief_scale == pytest.approx(np.hypot(0.1, 0.2))


def test_a_picture_is_the_likelier_the_more_similar():
    model = Likelihood(sight=10.0, grey=0.5, sight_least=0.01)
    similar = np.array([[1.0, 0.6], [1.0, 0.2]])
    first, second = model.of_picture(similar)
    assert first == pytest.approx(-15 * np.log(0.01))
    assert second == pytest.approx(-10 * (np.log(0.41) + 0.5 * np.log(0.81)))
