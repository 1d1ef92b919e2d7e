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
)

TRAIN, TEST = np.arange(0, 120, 2), np.arange(1, 120, 2)


def blobs(width=8, apart=6.0):
    """(samples, labels): three classes as clouds round random places."""
    random = np.random.default_rng(0)
    labels = np.repeat([0, 1, 2], 40)
    return apart * random.normal(size=(3, width))[labels] + random.normal(size=(120, width)), labels


@pytest.mark.slow
@pytest.mark.parametrize("dimensions", MAP_DIMENSIONS)
def test_places_lie_in_a_cube_and_all_maps_have_about_as_many_neurons_near_the_samples(dimensions):
    samples, _ = blobs()
    network = SelfOrganisingMap(dimensions).fit(samples)
    places = network.transform(samples)
    assert places.shape == (len(samples), dimensions) and places.min() >= 0 and places.max() <= 1
    assert NEURONS / 2 < len(network.neurons_) < 2 * NEURONS
    off = np.linalg.norm(samples[:, None] - network.neurons_, axis=2).min(axis=1).mean()
    assert off < 0.5 * np.linalg.norm(samples - samples.mean(axis=0), axis=1).mean()


def test_neighbours_stay_neighbours():
    along = np.linspace(0, 1, 200)[:, None]
    curve = np.hstack([along, along**2, np.sin(2 * along)])
    places = SelfOrganisingMap(1).fit_transform(curve)[:, 0]
    steps = np.diff(places)
    assert (steps >= 0).all() or (steps <= 0).all()
    assert np.ptp(places) > 0.9


def test_neurons_far_from_any_sample_stay_between_the_samples():
    samples = np.r_[np.full((9, 2), 100.0), np.full((9, 2), 101.0)]
    neurons = SelfOrganisingMap(1).fit(samples).neurons_
    assert neurons.min() > 99 and neurons.max() < 102


def test_map_depends_neither_on_order_nor_on_chance():
    samples, _ = blobs()
    order = np.random.default_rng(1).permutation(len(samples))
    first, other = SelfOrganisingMap(3).fit(samples), SelfOrganisingMap(3).fit(samples[order])
    np.testing.assert_allclose(first.neurons_, other.neurons_, atol=1e-8)


def test_constant_column_and_equal_samples_are_no_trouble():
    samples, _ = blobs()
    samples[:, 2] = 5.0
    assert np.isfinite(SelfOrganisingMap(2).fit(samples).neurons_).all()
    assert np.isfinite(SelfOrganisingMap(2).fit(np.ones((6, 3))).neurons_).all()


@pytest.mark.parametrize(
    ("samples", "dimensions", "word"),
    [(np.zeros((5, 3)), 4, "as many"), (np.zeros((1, 3)), 2, "as many"), (np.zeros((5, 3)), 0, "1 to 8"),
     (np.full((5, 3), np.nan), 2, "NaN")],
)  # fmt: skip
def test_bad_input_is_named(samples, dimensions, word):
    with pytest.raises(ValueError, match=word):
        SelfOrganisingMap(dimensions).fit(samples)


def test_gain_is_that_of_scikit_learn_and_for_the_class_itself_its_entropy():
    labels = np.repeat([0, 1], 50)
    samples = np.random.default_rng(0).normal(size=(100, 3))
    samples[:, 1] = labels
    selection = MostInformative(1).fit(samples, labels)
    assert selection.chosen_.tolist() == [1] and selection.gains_[1] == pytest.approx(np.log(2))
    np.testing.assert_array_equal(selection.transform(samples)[:, 0], labels)
    random = np.random.default_rng(0)
    parts, labels = random.integers(0, 10, (80, 5)), random.integers(3, 7, 80)
    expected = [mutual_info_score(labels, column) for column in parts.T]
    np.testing.assert_allclose(mutual_information(parts, labels), expected, rtol=1e-12)


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
def test_every_classifier_tells_far_clouds_apart():
    samples, labels = blobs(width=30)
    reduced = Reduced(samples, labels, TRAIN, TEST)
    for name in CONVENTIONAL:
        predicted = reduced.predict(name, None if name.endswith("no_som") else 3)[0]
        assert (predicted == reduced.test_labels).mean() > 0.9, name


def test_neighbours_are_ten_and_fewer_where_there_are_fewer_samples():
    samples, labels = blobs(width=30)
    assert ESTIMATORS["knn"](True).fit(samples, labels).nearest_.n_neighbors == 10
    assert ESTIMATORS["knn"](False).fit(samples[::20], labels[::20]).nearest_.n_neighbors == 6


def test_reduction_is_fitted_to_the_training_samples_and_shared_and_the_best_size_counts():
    samples, labels = blobs(apart=1.0, width=30)
    changed, wrong = samples.copy(), labels.copy()
    changed[TEST], wrong[TEST] = 1e3, 0
    first, other = Reduced(samples, labels, TRAIN, TEST), Reduced(changed, wrong, TRAIN, TEST)
    for dimensions in (None, 2):
        np.testing.assert_array_equal(first.mapped(dimensions).train, other.mapped(dimensions).train)
    assert first.mapped(2) is first.mapped(2) and first.mapped(2).train.shape == (60, 2)
    assert first.predict("knn", 2)[1] > first.mapped(2).seconds > first.mapped(None).seconds > 0
    right = [(first.predict("knn", size)[0] == first.test_labels).mean() for size in MAP_DIMENSIONS]
    assert choose_dimensions("knn", first)[0] == MAP_DIMENSIONS[int(np.argmax(right))]  # of equals the smallest
