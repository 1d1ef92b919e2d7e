"""How alike two imprints are."""

import numpy as np
import pytest
from skimage.feature import match_template

from haptic_glance.know import confusable, similarity
from haptic_glance.know.features import as_many

RANDOM = np.random.default_rng(0)
IMAGES = RANDOM.random((5, 9, 7))


def test_agrees_with_a_template_match_at_zero_lag():
    expected = [[match_template(one, other)[0, 0] for other in IMAGES] for one in IMAGES]
    assert np.allclose(similarity(IMAGES), expected)
    assert np.allclose(similarity(IMAGES[:2], IMAGES[1:]), np.array(expected)[:2, 1:])


def test_an_imprint_is_one_with_itself_however_hard_it_was_pressed():
    assert np.allclose(np.diag(similarity(IMAGES)), 1)
    assert np.allclose(similarity(IMAGES, 0.3 * IMAGES + 0.2), similarity(IMAGES))
    assert np.allclose(np.diag(similarity(IMAGES, 1 - IMAGES)), -1)


@pytest.mark.parametrize("value", [0.0, 0.3, 1.0])
def test_flat_imprints_are_like_each_other_and_like_nothing_else(value):
    images = np.concatenate([IMAGES[:1], np.full((1, 9, 7), value), np.zeros((1, 9, 7))])
    assert np.allclose(similarity(images), [[1, 0, 0], [0, 1, 1], [0, 1, 1]])


def test_shared_are_those_that_another_object_has_too():
    images = np.concatenate([IMAGES[:2], IMAGES[:1], IMAGES[2:4]])
    similarities = similarity(images)
    assert confusable(similarities, ["a", "a", "b", "b", "b"]).tolist() == [True, False, True, False, False]
    assert not confusable(similarities, ["a", "a", "a", "b", "b"]).any()
    assert not confusable(similarities, ["a", "a", "b", "b", "b"], among=[0, 1, 3]).tolist()[0]


@pytest.mark.parametrize("bad", [np.zeros((9, 7)), np.full((1, 9, 7), np.nan)])
def test_what_is_no_stack_of_imprints_is_refused(bad):
    with pytest.raises(ValueError, match="images must be finite"):
        similarity(bad)


def test_a_control_of_selection_keeps_as_many_of_each_object():
    labels = np.array(["a"] * 5 + ["b"] * 5)
    kept = np.array([True, True, False, False, False] + [True] * 4 + [False])
    drawn = [as_many(labels, kept, np.random.default_rng(seed)) for seed in range(20)]
    assert {(one[:5].sum(), one[5:].sum()) for one in drawn} == {(2, 4)}
    assert len({tuple(one) for one in drawn}) > 5


def test_imprints_of_two_arrays_cannot_be_compared():
    with pytest.raises(ValueError, match="the same number of cells: 63 and 64"):
        similarity(IMAGES, np.zeros((1, 8, 8)))
