"""How two senses become one answer, and how far each is trusted."""

import numpy as np
import pytest
from scipy.special import softmax

from stages.transfer.fusion import FUSIONS, best_temperature, certainty, fuse, probabilities

pytestmark = pytest.mark.slow


def chances(seed, count=50, classes=4):
    return softmax(np.random.default_rng(seed).normal(size=(count, classes)), axis=1)


@pytest.fixture(scope="module")
def scored():
    """(logits, labels) of a network whose probabilities are right: the labels are drawn from them."""
    generator = np.random.default_rng(0)
    logits = generator.normal(size=(4000, 5)) * 2
    return logits, np.array([generator.choice(5, p=row) for row in softmax(logits, axis=1)])


@pytest.mark.parametrize("rule", FUSIONS)
def test_fused_probabilities_favour_no_sense_and_overrule_no_agreement(rule):
    vision, touch = chances(1), chances(2)
    fused = fuse(vision, touch, rule)
    assert (fused >= 0).all() and np.allclose(fused.sum(axis=1), 1)
    assert np.allclose(fused, fuse(touch, vision, rule))
    agree = vision.argmax(axis=1) == touch.argmax(axis=1)
    assert agree.any() and (fused.argmax(axis=1) == vision.argmax(axis=1))[agree].all()


@pytest.mark.parametrize("rule", FUSIONS)
def test_a_missing_sense_leaves_the_other_as_it_is(rule):
    vision, touch = chances(1), chances(2)
    vision[:10], touch[5:20] = np.nan, np.nan
    fused = fuse(vision, touch, rule)
    assert np.array_equal(fused[:5], touch[:5])
    assert np.isnan(fused[5:10]).all()
    assert np.array_equal(fused[10:20], vision[10:20])


@pytest.mark.parametrize("rule", ["product", "entropy", "surest"])
def test_a_sense_that_knows_nothing_changes_no_answer(rule):
    vision, nothing = chances(1), np.full((50, 4), 0.25)
    assert np.array_equal(fuse(vision, nothing, rule).argmax(axis=1), vision.argmax(axis=1))


def test_product_is_the_bayes_rule_of_independent_senses():
    """Two noisy sensors of a coin with known errors: the posterior has a closed form."""
    vision, touch = np.array([[0.9, 0.1]]), np.array([[0.3, 0.7]])
    assert np.allclose(fuse(vision, touch, "product"), [[0.27 / 0.34, 0.07 / 0.34]])


def test_certainty_runs_from_nothing_to_all():
    assert np.allclose(certainty(np.array([[0.25] * 4, [1, 0, 0, 0], [0.5, 0.5, 0, 0]])), [0, 1, 0.5])


@pytest.mark.parametrize("true", [1.0, 4.0])
def test_the_temperature_of_scores_is_found_again(scored, true):
    logits, labels = scored
    assert best_temperature(logits * true, labels) == pytest.approx(true, rel=0.1)


def test_a_temperature_never_makes_a_network_surer():
    right = np.eye(4) * 3.0  # every item right: the sharper, the likelier
    assert best_temperature(right, np.arange(4)) == pytest.approx(1, abs=1e-3)


def test_a_temperature_changes_no_first_class(scored):
    logits, _ = scored
    raw, cool = probabilities(logits * 5), probabilities(logits * 5, 5.0)
    assert raw.max() > cool.max()
    assert np.array_equal(raw.argmax(axis=1), cool.argmax(axis=1))
