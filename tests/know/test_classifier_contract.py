"""Every entry of CLASSIFIERS: it learns, the seed and the samples decide, and the hold-out leaks into nothing."""

import numpy as np
import pytest

from haptic_glance.know import CLASSIFIERS, classifier, evaluate
from haptic_glance.know.protocol import Prepared, random_holdout

pytestmark = pytest.mark.slow

LABELS = np.repeat(["cup", "duck", "hand"], 30)
SAMPLES = np.random.default_rng(0).normal(size=(90, 44)) + 3 * np.repeat(np.eye(3, 44), 30, axis=0)


def accuracy(rows, split):
    return np.mean([row["value"] for row in rows if (row["metric"], row["split"]) == ("accuracy", split)])


@pytest.mark.parametrize("name", CLASSIFIERS)
def test_it_beats_chance_on_what_is_easy_and_not_on_noise(bumps, name):
    rows = evaluate(bumps(count=24), name, 3)
    assert accuracy(rows, "random") > 0.8 and accuracy(rows, "folds") > 0.7
    images = dict(zip("abc", np.random.default_rng(1).random((3, 40, 16, 16)), strict=True))
    assert accuracy(evaluate(images, name, 4), "random") < 0.6


@pytest.mark.parametrize("name", CLASSIFIERS)
def test_answers_are_labels_that_it_learned_and_come_again_by_the_seed(name):
    first, again = (classifier(name, 3).fit(SAMPLES[::2], LABELS[::2]).predict(SAMPLES[1::2]) for _ in range(2))
    assert first.shape == (45,) and set(first) <= set(LABELS) and np.array_equal(first, again)
    assert (classifier(name, 3).fit(SAMPLES, LABELS).predict(SAMPLES) == LABELS).mean() > 0.8


@pytest.mark.parametrize("name", CLASSIFIERS)
def test_what_is_held_out_changes_nothing_that_was_learned(name):
    """One sample of the hold-out has one answer, whatever the others are, and their labels are never read."""
    train, test = random_holdout(LABELS, 3)
    other, wrong = SAMPLES.copy(), LABELS.copy()
    other[test[1:]] += 100
    wrong[test] = "cup"
    ours = Prepared.from_split(SAMPLES, LABELS, (train, test))
    theirs = Prepared.from_split(other, wrong, (train, test))
    assert np.array_equal(ours.train, theirs.train)
    assert ours.predict(name, 3)[0][0] == theirs.predict(name, 3)[0][0]
    model = classifier(name, 3).fit(SAMPLES[train], LABELS[train])
    assert np.array_equal(ours.predict(name, 3)[0], model.predict(SAMPLES[test]))


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda bumps: evaluate(bumps(), "knm"), "did you mean knn"),
        (lambda bumps: evaluate(bumps() | {"cup": np.zeros((9, 16, 16))}, "knn"), "cup has 9 imprints"),
        (lambda bumps: evaluate(bumps() | {"cup": np.zeros((20, 4, 4))}, "knn"), "at least 8 x 8"),
        (lambda bumps: evaluate(bumps() | {"cup": np.zeros((20, 8, 8))}, "knn"), "imprints of several arrays"),
        (lambda bumps: evaluate(bumps(("cup",)), "knn"), "two objects"),
        (lambda bumps: evaluate(bumps() | {"cup": np.full((20, 16, 16), 9.0)}, "knn"), "bytes, or numbers in 0..1"),
        (lambda bumps: evaluate(bumps(), "knn", 0), "repetitions must be 1 or more, got 0"),
        (lambda _: classifier("knn", 0, "places"), "kind must be one of features, located, reduced"),
        (lambda _: classifier("knn", scaling="none"), "scaling must be one of training, .*, min_max, got 'none'"),
    ],
)
def test_what_cannot_be_learned_is_named(bumps, call, words):
    with pytest.raises(ValueError, match=words):
        call(bumps)
