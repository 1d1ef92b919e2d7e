"""The fixation model: a log-linear density of looks."""

import numpy as np
import pytest

from haptic_glance.look.weights import fit_fixations, fixation_density
from haptic_glance.look.weights.attention import standardise

TRUE = np.array([1.2, -0.7, 0.0])


def looks(count, seed):
    """(features, amounts, areas) of one object whose looks follow TRUE."""
    random = np.random.default_rng(seed)
    features, areas = random.normal(size=(2000, 3)), random.uniform(0.5, 1.5, 2000)
    share = areas * np.exp(features @ TRUE)
    return features, random.multinomial(count, share / share.sum()).astype(float), areas


def test_the_model_finds_the_weights_that_made_the_looks_and_a_ridge_pulls_them_towards_zero():
    objects = [looks(20000, seed) for seed in range(3)]
    assert fit_fixations(*zip(*objects, strict=True), ridge=0) == pytest.approx(TRUE, abs=0.03)
    single = list(zip(looks(2000, 0), strict=True))
    free, held = (np.linalg.norm(fit_fixations(*single, ridge=ridge)) for ridge in (0, 0.5))
    assert held < 0.8 * free
    features, _, areas = looks(1, 0)  # looks spread by area alone teach nothing
    assert np.abs(fit_fixations([features], [areas], [areas])).max() < 0.05


def test_an_object_counts_once_however_long_people_looked_and_a_vertex_without_area_takes_no_part():
    features, amounts, areas = looks(20000, 0)
    other = looks(200, 1)
    once, longer = (
        fit_fixations((features, other[0]), (scale * amounts, other[1]), (areas, other[2])) for scale in (1, 50)
    )
    assert once == pytest.approx(longer, abs=1e-5)
    stray = np.r_[features, [[50.0, 50, 50]]], np.r_[amounts, 0], np.r_[areas, 0]
    plain = fit_fixations([features], [amounts], [areas])
    assert fit_fixations(*([part] for part in stray)) == pytest.approx(plain, abs=1e-5)


def test_the_density_is_at_most_one_and_grows_with_a_feature():
    density = fixation_density({"height": np.array([0.0, 1.0, 2.0])}, {"height": 0.5})
    assert density == pytest.approx(np.exp([-1.0, -0.5, 0.0]))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: fit_fixations([], [], []), "no object"),
        (lambda: fit_fixations([np.ones((2, 1))], [np.zeros(2)], [np.ones(2)]), "without fixations"),
        (lambda: fixation_density({"height": np.zeros(3)}, {"height": np.nan}), "finite"),
        (lambda: fixation_density({"height": np.zeros(3)}, {"shine": 1.0}), "shine to weigh: there are height$"),
        (lambda: fixation_density({"height": np.zeros(3)}, {}), "no feature"),
    ],
)
def test_nothing_to_learn_from_and_bad_weights_are_errors(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_a_feature_has_mean_zero_and_deviation_one_over_the_area_and_a_constant_says_nothing():
    areas = np.array([1.0, 2, 5, 0])
    scaled = standardise(np.array([3.0, 1, 2, 9]), areas)
    assert areas @ scaled == pytest.approx(0) and areas @ scaled**2 == pytest.approx(8) and scaled[3] == 0
    assert not standardise(np.full(5, 7.3), np.ones(5)).any()
    assert not standardise(np.arange(5.0), np.zeros(5)).any()
