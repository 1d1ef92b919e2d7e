"""The self-organising map and the selection before it."""

import numpy as np
import pytest
from sklearn.metrics import mutual_info_score

from haptic_glance.know.self_organising_map import NEURONS, SelfOrganisingMap
from stages.sequences.classifiers import (
    CONVENTIONAL,
    ESTIMATORS,
    MAP_DIMENSIONS,
    MostInformative,
    Reduced,
    choose_dimensions,
    mutual_information,
    svm,
)


def blobs(count=40, classes=3, width=8, apart=6.0, seed=0):
    """(samples, labels): classes as clouds round random places."""
    random = np.random.default_rng(seed)
    labels = np.repeat(np.arange(classes), count)
    return apart * random.normal(size=(classes, width))[labels] + random.normal(size=(len(labels), width)), labels


@pytest.mark.slow
@pytest.mark.parametrize("dimensions", MAP_DIMENSIONS)
def test_places_lie_in_the_cube_of_the_size(dimensions):
    samples, _ = blobs()
    found = SelfOrganisingMap(dimensions).fit_transform(samples)
    assert found.shape == (len(samples), dimensions)
    assert found.min() >= 0 and found.max() <= 1


def test_maps_of_all_sizes_have_about_as_many_neurons():
    samples, _ = blobs()
    for dimensions in MAP_DIMENSIONS:
        neurons = len(SelfOrganisingMap(dimensions).fit(samples).neurons_)
        assert NEURONS / 2 < neurons < 2 * NEURONS


def test_neighbours_stay_neighbours():
    along = np.linspace(0, 1, 200)[:, None]
    curve = np.hstack([along, along**2, np.sin(2 * along)])
    places = SelfOrganisingMap(1).fit_transform(curve)[:, 0]
    steps = np.diff(places)
    assert (steps >= 0).all() or (steps <= 0).all()
    assert np.ptp(places) > 0.9


def test_neurons_come_nearer_to_the_samples():
    samples, _ = blobs()
    network = SelfOrganisingMap(2).fit(samples)
    nearest = network.neurons_[network._nearest(samples)]
    assert (
        np.linalg.norm(samples - nearest, axis=1).mean()
        < 0.5 * np.linalg.norm(samples - samples.mean(axis=0), axis=1).mean()
    )


def test_map_depends_neither_on_order_nor_on_chance():
    samples, _ = blobs()
    order = np.random.default_rng(1).permutation(len(samples))
    one, other = SelfOrganisingMap(3).fit(samples), SelfOrganisingMap(3).fit(samples[order])
    np.testing.assert_allclose(one.neurons_, other.neurons_, atol=1e-8)


def test_constant_column_and_equal_samples_are_no_trouble():
    samples, _ = blobs()
    samples[:, 2] = 5.0
    assert np.isfinite(SelfOrganisingMap(4).fit(samples).neurons_).all()
    assert np.isfinite(SelfOrganisingMap(2).fit(np.ones((6, 3))).neurons_).all()


@pytest.mark.parametrize(
    ("samples", "dimensions", "word"),
    [(np.zeros((5, 3)), 4, "as many"), (np.zeros((1, 3)), 2, "as many"), (np.zeros((5, 3)), 0, "1 to 8"),
     (np.full((5, 3), np.nan), 2, "NaN")],
)  # fmt: skip
def test_bad_input_is_named(samples, dimensions, word):
    with pytest.raises(ValueError, match=word):
        SelfOrganisingMap(dimensions).fit(samples)


def test_gain_of_a_feature_that_is_the_class_is_the_entropy_of_the_class():
    labels = np.repeat([0, 1], 50)
    samples = np.random.default_rng(0).normal(size=(100, 3))
    samples[:, 1] = labels
    found = MostInformative(1).fit(samples, labels)
    assert found.chosen_.tolist() == [1]
    assert found.gains_[1] == pytest.approx(np.log(2))
    np.testing.assert_array_equal(found.transform(samples)[:, 0], labels)


def test_gain_of_a_constant_is_zero_and_does_not_change_with_a_rising_scale():
    samples, labels = blobs()
    samples[:, 0] = 3.0
    gains = MostInformative().fit(samples, labels).gains_
    assert gains[0] == pytest.approx(0, abs=1e-12)
    np.testing.assert_allclose(MostInformative().fit(samples**3 * 7, labels).gains_, gains)


def test_of_equal_gains_the_first_features_are_kept():
    random, labels = np.random.default_rng(0), np.repeat(np.arange(5), [11, 13, 17, 19, 40])
    samples = np.stack([random.permutation(5)[labels] for _ in range(40)], axis=1)  # the classes by other names
    assert MostInformative(40).fit(samples, labels).chosen_.tolist() == list(range(40))


@pytest.mark.slow
@pytest.mark.parametrize("name", CONVENTIONAL)
def test_every_classifier_tells_far_clouds_apart(name):
    samples, labels = blobs(width=30)
    dimensions = None if name.endswith("no_som") else 3
    found = Reduced(samples, labels, np.arange(0, 120, 2), np.arange(1, 120, 2))
    assert (found.predict(name, dimensions)[0] == found.test_labels).mean() > 0.9


def test_settings_are_the_thesis_s():
    estimator = svm(reduced=True)
    assert (estimator.kernel, estimator.gamma, estimator.C, estimator.tol) == ("rbf", 1.0, 1.0, 0.5)
    samples, labels = blobs(width=30)
    assert ESTIMATORS["knn"](True).fit(samples, labels).nearest_.n_neighbors == 10
    assert ESTIMATORS["knn"](False).fit(samples[::20], labels[::20]).nearest_.n_neighbors == 6


def test_information_is_that_of_scikit_learn():
    random = np.random.default_rng(0)
    parts, labels = random.integers(0, 10, (80, 5)), random.integers(3, 7, 80)
    expected = [mutual_info_score(labels, column) for column in parts.T]
    np.testing.assert_allclose(mutual_information(parts, labels), expected, rtol=1e-12)


def test_reduction_is_fitted_to_the_training_samples_and_shared_by_the_classifiers():
    samples, labels = blobs(apart=1.0, width=30)
    train, test = np.arange(0, 120, 2), np.arange(1, 120, 2)
    changed, wrong = samples.copy(), labels.copy()
    changed[test], wrong[test] = 1e3, 0
    one, other = Reduced(samples, labels, train, test), Reduced(changed, wrong, train, test)
    for dimensions in (None, 2):
        np.testing.assert_array_equal(one.mapped(dimensions).train, other.mapped(dimensions).train)
    assert one.mapped(2) is one.mapped(2) and one.mapped(2).train.shape == (60, 2)
    assert one.predict("knn", 2)[1] > one.mapped(2).seconds > one.mapped(None).seconds > 0


def test_best_size_counts_and_of_equals_the_smallest():
    samples, labels = blobs(apart=1.0, width=30)
    found = Reduced(samples, labels, np.arange(0, 120, 2), np.arange(1, 120, 2))
    right = [(found.predict("knn", each)[0] == found.test_labels).mean() for each in MAP_DIMENSIONS]
    assert choose_dimensions("knn", found)[0] == MAP_DIMENSIONS[int(np.argmax(right))]
