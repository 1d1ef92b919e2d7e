"""Several touches as one sample, and how alike two imprints are."""

import numpy as np
import pytest
from skimage.feature import match_template

from haptic_glance.know import concatenate_touches, confusable, draw_combinations, similarity, touch_map
from haptic_glance.know.features import as_many

RANDOM = np.random.default_rng(0)
IMAGES = RANDOM.random((5, 9, 7))
TRUTH = np.repeat([0, 1, 2], 8)


def test_map_keeps_neighbours_near_and_strangers_apart():
    samples = np.concatenate([RANDOM.normal(5 * k, 1, size=(40, 6)) for k in (-1, 0, 1)])
    places = touch_map().fit(samples).transform(samples)
    assert places.shape == (120, 2) and places.min() >= 0 and places.max() <= 1
    centres = places.reshape(3, 40, 2).mean(axis=1)
    spread = np.linalg.norm(places.reshape(3, 40, 2) - centres[:, None], axis=2).mean()
    assert min(np.linalg.norm(centres[a] - centres[b]) for a, b in ((0, 1), (1, 2))) > 1.3 * spread
    assert np.linalg.norm(centres[0] - centres[2]) > np.linalg.norm(centres[0] - centres[1]) * 1.2


def test_map_is_decided_by_the_training_samples_alone_and_bears_a_feature_that_never_changes():
    samples, others = RANDOM.normal(size=(30, 4)), RANDOM.normal(size=(9, 4))
    samples[:, 3] = 1
    places = touch_map().fit(samples).transform(others)
    assert np.isfinite(places).all() and np.array_equal(places, touch_map().fit(samples).transform(others))
    assert np.array_equal(places[:2], touch_map().fit(samples).transform(others[:2]))
    assert not np.array_equal(places, touch_map().fit(others).transform(others))


@pytest.mark.parametrize("count", [1, 3, 8])
def test_each_imprint_begins_one_combination_of_different_imprints_of_its_object(count):
    joined = draw_combinations(TRUTH, count, np.random.default_rng(0))
    assert joined.shape == (24, count) and np.array_equal(joined[:, 0], np.arange(24))
    assert (TRUTH[joined] == TRUTH[:, None]).all()
    assert all(len(set(row)) == count for row in joined.tolist())
    with pytest.raises(ValueError, match="an object has 8 imprints, a combination needs 9"):
        draw_combinations(TRUTH, 9, np.random.default_rng(0))


def test_joined_numbers_stand_one_touch_after_another():
    numbers = np.arange(48).reshape(24, 2)
    assert concatenate_touches(numbers, np.array([[2, 0], [5, 23]])).tolist() == [[4, 5, 0, 1], [10, 11, 46, 47]]


def test_similarity_is_a_template_match_at_zero_lag_however_hard_it_was_pressed():
    expected = [[match_template(image, other)[0, 0] for other in IMAGES] for image in IMAGES]
    assert np.allclose(similarity(IMAGES), expected)
    assert np.allclose(similarity(IMAGES[:2], IMAGES[1:]), np.array(expected)[:2, 1:])
    assert np.allclose(similarity(IMAGES, 0.3 * IMAGES + 0.2), expected)
    assert np.allclose(np.diag(similarity(IMAGES, 1 - IMAGES)), -1)


@pytest.mark.parametrize("value", [0.0, 0.3, 1.0])
def test_flat_imprints_are_like_each_other_and_like_nothing_else(value):
    images = np.concatenate([IMAGES[:1], np.full((1, 9, 7), value), np.zeros((1, 9, 7))])
    assert np.allclose(similarity(images), [[1, 0, 0], [0, 1, 1], [0, 1, 1]])


def test_shared_are_those_that_another_object_has_too():
    similarities = similarity(np.concatenate([IMAGES[:2], IMAGES[:1], IMAGES[2:4]]))
    assert confusable(similarities, ["a", "a", "b", "b", "b"]).tolist() == [True, False, True, False, False]
    assert not confusable(similarities, ["a", "a", "a", "b", "b"]).any()
    assert not confusable(similarities, ["a", "a", "b", "b", "b"], among=[0, 1, 3]).tolist()[0]


def test_a_control_of_selection_keeps_as_many_of_each_object():
    labels = np.array(["a"] * 5 + ["b"] * 5)
    kept = np.array([True, True, False, False, False] + [True] * 4 + [False])
    drawn = [as_many(labels, kept, np.random.default_rng(seed)) for seed in range(20)]
    assert {(mask[:5].sum(), mask[5:].sum()) for mask in drawn} == {(2, 4)}
    assert len({tuple(mask) for mask in drawn}) > 5
