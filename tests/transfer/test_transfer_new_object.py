"""How well few touches tell new objects apart, on features with a known truth."""

import numpy as np
import pytest
from sklearn.neighbors import KNeighborsClassifier

from stages.transfer.new_object import LEARNERS, scores


@pytest.mark.parametrize("learner", LEARNERS)
def test_touches_that_were_learned_are_not_asked_about(learner):
    """Every touch is like no other of its object, so that only one that was learned could be recognised."""
    objects, features = np.repeat([0, 1], 4), np.eye(8)
    features[:, 0] = np.tile([0, 1], 4)  # misleads: as often in either object
    draws = [np.random.default_rng(k).permutation(8) for k in range(10)]
    found, _ = scores(learner, features, objects, draws, 2, 2)
    assert np.mean(list(found.values())) < 0.9


@pytest.mark.parametrize("learner", LEARNERS)
def test_one_touch_is_enough_where_objects_lie_apart(learner):
    objects = np.repeat([3, 7], 5)
    features = 9.0 * objects[:, None] + np.random.default_rng(0).normal(size=(10, 4))
    draws = [np.random.default_rng(k).permutation(10) for k in range(3)]
    assert scores(learner, features, objects, draws, 1, 3)[0] == {3: 1.0, 7: 1.0}


def test_as_many_touches_of_each_object_are_learned_as_are_asked_for(monkeypatch):
    learned = []

    class Spy(KNeighborsClassifier):
        def fit(self, X, y):
            learned.append(np.unique(y, return_counts=True)[1].tolist())
            return super().fit(X, y)

    monkeypatch.setitem(LEARNERS, "head", lambda: Spy(n_neighbors=1))
    objects = np.repeat([0, 1, 2], 6)
    scores("head", np.random.default_rng(0).normal(size=(18, 4)), objects, [np.arange(18)], 3, 4)
    assert learned == [[3, 3, 3]]
