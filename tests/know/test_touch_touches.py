"""Several touches as one sample."""

import numpy as np
import pytest

from haptic_glance.know import concatenate_touches, draw_combinations, touch_map

RANDOM = np.random.default_rng(0)
TRUTH = np.repeat([0, 1, 2], 8)


def test_map_keeps_neighbours_near_and_strangers_apart():
    samples = np.concatenate([RANDOM.normal(5 * k, 1, size=(40, 6)) for k in (-1, 0, 1)])
    places = touch_map().fit(samples).transform(samples)
    assert places.shape == (120, 2) and places.min() >= 0 and places.max() <= 1
    centres = places.reshape(3, 40, 2).mean(axis=1)
    spread = np.linalg.norm(places.reshape(3, 40, 2) - centres[:, None], axis=2).mean()
    assert min(np.linalg.norm(centres[a] - centres[b]) for a, b in ((0, 1), (1, 2))) > 1.3 * spread
    assert np.linalg.norm(centres[0] - centres[2]) > np.linalg.norm(centres[0] - centres[1]) * 1.2


def test_map_is_decided_by_the_training_samples_alone():
    samples, others = RANDOM.normal(size=(30, 4)), RANDOM.normal(size=(9, 4))
    first_of_each = touch_map().fit(samples).transform(others)
    assert np.array_equal(first_of_each, touch_map().fit(samples).transform(others))
    assert np.array_equal(first_of_each[:2], touch_map().fit(samples).transform(others[:2]))
    assert not np.array_equal(first_of_each, touch_map().fit(others).transform(others))


def test_map_bears_a_feature_that_never_changes():
    samples = np.hstack([RANDOM.normal(size=(30, 3)), np.ones((30, 1))])
    assert np.isfinite(touch_map().fit(samples).transform(samples)).all()


@pytest.mark.parametrize("count", [1, 3, 8])
def test_each_imprint_begins_one_combination_of_different_imprints_of_its_object(count):
    joined = draw_combinations(TRUTH, count, np.random.default_rng(0))
    assert joined.shape == (24, count) and np.array_equal(joined[:, 0], np.arange(24))
    assert (TRUTH[joined] == TRUTH[:, None]).all()
    assert all(len(set(row)) == count for row in joined.tolist())


def test_combination_larger_than_an_object_is_refused():
    with pytest.raises(ValueError, match="an object has 8 imprints, a combination needs 9"):
        draw_combinations(TRUTH, 9, np.random.default_rng(0))


def test_joined_numbers_stand_one_touch_after_another():
    numbers = np.arange(48).reshape(24, 2)
    assert concatenate_touches(numbers, np.array([[2, 0], [5, 23]])).tolist() == [[4, 5, 0, 1], [10, 11, 46, 47]]
