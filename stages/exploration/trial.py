"""One hold-out of places: learn from some touches of each object, then explore with the others."""

import numpy as np

from .belief import calibrate
from .hold_out import hold_out
from .likelihood import feature_kernel, log_likelihood, place_kernel

LIKELIHOODS = ("imprint", "imprint_place", "imprint_product")  # what is felt; and where; and as if independent
INNER = 6  # hold-outs of the training touches that the belief is calibrated on
ORDERS = 5  # orders in which each object's inner test touches are taken
NEAREST = 8  # known touches of an object near a place that say what it would feel like there
NEAR = 0.08  # units, half an array: how fast a known touch stops telling what is felt near it


class Trial:
    """Log likelihoods of the held-out touches, of what could be felt, and the calibration, for one likelihood.

    samples (k, d) components, places (k, 3), truth (k,) objects from 0, all with equally many touches; train, test:
    indices; split, apart: how they were held out (`hold_out`), since the calibration holds out in the same way.
    """

    def __init__(self, samples, places, truth, train, test, likelihood, split, apart, random):
        self.classes = int(truth.max()) + 1
        self.truth = truth[test].reshape(self.classes, -1)[:, 0]
        self._known, self._places = truth[train], places[train]
        self._kernel = feature_kernel(samples[train], samples[train])
        self._where = likelihood == "imprint_place"
        both = feature_kernel(samples[test], samples[train])
        seen = place_kernel(places[test], places[train])
        felt = log_likelihood(both * seen if self._where else both, self._known)
        self.felt = felt.reshape(self.classes, -1, self.classes)
        self.calibration = self._calibrate(split, apart, likelihood != "imprint_product", random)
        gaps = np.linalg.norm(places[test][:, None] - self._places[None], axis=2)
        self.foreseen, self.chances = self._foresee(seen, gaps, apart if split == "apart" else 0.0)

    def _calibrate(self, split, apart, sharing, random):
        """The Calibration learned from hold-outs of the training touches."""
        kernel = self._kernel * place_kernel(self._places, self._places) if self._where else self._kernel
        sequences, owners = [], []
        for _ in range(INNER):
            learn, check = hold_out(self._known, self._places, split, apart, random)
            found = log_likelihood(kernel[np.ix_(check, learn)], self._known[learn])
            for one in range(self.classes):
                own = found[self._known[check] == one]
                sequences += [random.permutation(own) for _ in range(ORDERS)]
                owners += [one] * ORDERS
        shortest = min(map(len, sequences))
        return calibrate(np.stack([one[:shortest] for one in sequences]), np.array(owners), sharing)

    def _foresee(self, seen, gaps, apart):
        """(foreseen, chances) of `State` for the test places: what the known touches nearest to a place felt like.

        seen, gaps (k, n): kernel and distance of the test places to the known ones. A known touch speaks for what
        could be felt as if it were new itself: known touches of its object within `apart`, and itself, do not count.
        """
        apart_enough = np.linalg.norm(self._places[:, None] - self._places[None], axis=2) > apart
        np.fill_diagonal(apart_enough, False)
        counts = apart_enough | (self._known[:, None] != self._known[None])
        kernel = self._kernel * counts
        number = counts @ np.eye(self.classes)[self._known]
        outcomes, chances = self._nearest(gaps)
        if self._where:
            kernels = kernel[outcomes] * seen[:, None, None]  # (k, classes, outcomes, n)
            foreseen = log_likelihood(kernels, self._known, number[outcomes])
        else:
            foreseen = log_likelihood(kernel, self._known, number)[outcomes]
        shape = (self.classes, -1, *outcomes.shape[1:])
        return foreseen.reshape(*shape, self.classes), chances.reshape(shape)

    def _nearest(self, gaps):
        """(outcomes (k, classes, o) known touches of each object nearest to a place, their chances)."""
        own = [np.flatnonzero(self._known == one) for one in range(self.classes)]
        count = min(NEAREST, *map(len, own))
        outcomes = np.stack([ids[np.argsort(gaps[:, ids], axis=1, kind="stable")[:, :count]] for ids in own], axis=1)
        near = np.take_along_axis(gaps[:, None], outcomes.reshape(len(gaps), 1, -1), axis=2).reshape(outcomes.shape)
        weights = np.exp(-(near - near[..., :1]) / NEAR)
        return outcomes, weights / weights.sum(axis=-1, keepdims=True)
