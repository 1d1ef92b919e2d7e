"""A trial of exploration: learn from some touches of each object, then explore with the others."""

import numpy as np

from .belief import calibrate, feature_kernel, log_likelihood, nearest_outcomes, place_kernel
from .protocol import HOLDOUT
from .split import Split

LIKELIHOODS = (
    "imprint",
    "imprint_place",
    "imprint_product",
)  # of imprints; of imprints and places; of imprints as if independent
INNER_SPLITS = 6  # hold-outs of the training touches, for calibration
ORDERS = 5  # random orders of each object's inner test touches


class Trial:
    """Log likelihoods of the held-out touches and of predicted touches, and the calibration, for one likelihood.

    samples (k, d) components, places (k, 3), truth (k,) objects from 0, all with equally many touches; train, test:
    indices; split, min_distance: as in `split_touches`, since the calibration splits in the same way.
    """

    def __init__(
        self,
        samples: np.ndarray,
        places: np.ndarray,
        truth: np.ndarray,
        train: np.ndarray,
        test: np.ndarray,
        likelihood: str,
        split: str,
        min_distance: float,
        random: np.random.Generator,
    ) -> None:
        self.classes = int(truth.max()) + 1
        self.truth = truth[test].reshape(self.classes, -1)[:, 0]
        self._known, self._places = truth[train], places[train]
        self._kernel = feature_kernel(samples[train], samples[train])
        self._uses_places = likelihood == "imprint_place"
        feature_weights = feature_kernel(samples[test], samples[train])
        place_weights = place_kernel(places[test], places[train])
        observed = log_likelihood(
            feature_weights * place_weights if self._uses_places else feature_weights, self._known
        )
        self.observed = observed.reshape(self.classes, -1, self.classes)
        self.calibration = self._calibrate(split, min_distance, likelihood != "imprint_product", random)
        distances = np.linalg.norm(places[test][:, None] - self._places[None], axis=2)
        gap = min_distance if split == Split.REGIONS else 0.0
        self.predicted, self.probabilities = self._predict(place_weights, distances, gap)

    def _calibrate(self, split, min_distance, redundancy, random):
        """The Calibration from hold-outs of the training touches."""
        kernel = self._kernel * place_kernel(self._places, self._places) if self._uses_places else self._kernel
        sequences, owners = [], []
        for _ in range(INNER_SPLITS):
            fit, check = split_touches(self._known, self._places, split, min_distance, random)
            log_likelihoods = log_likelihood(kernel[np.ix_(check, fit)], self._known[fit])
            for label in range(self.classes):
                of_object = log_likelihoods[self._known[check] == label]
                sequences += [random.permutation(of_object) for _ in range(ORDERS)]
                owners += [label] * ORDERS
        shortest = min(map(len, sequences))
        return calibrate(np.stack([sequence[:shortest] for sequence in sequences]), np.array(owners), redundancy)

    def _predict(self, place_weights, distances, min_distance):
        """(predicted, probabilities) of `State` for the test places, from the training touches nearest to a place.

        place_weights, distances (k, n): kernel and distance of the test places to the training places. A training touch
        is used like a new one: training touches of its object within `min_distance`, and itself, do not count.
        """
        far_enough = np.linalg.norm(self._places[:, None] - self._places[None], axis=2) > min_distance
        np.fill_diagonal(far_enough, False)
        counted = far_enough | (self._known[:, None] != self._known[None])
        kernel = self._kernel * counted
        counts = counted @ np.eye(self.classes)[self._known]
        outcomes, probabilities = nearest_outcomes(distances, self._known)
        if self._uses_places:
            kernels = kernel[outcomes] * place_weights[:, None, None]  # (k, classes, outcomes, n)
            predicted = log_likelihood(kernels, self._known, counts[outcomes])
        else:
            predicted = log_likelihood(kernel, self._known, counts)[outcomes]
        shape = (self.classes, -1, *outcomes.shape[1:])
        return predicted.reshape(*shape, self.classes), probabilities.reshape(shape)


# Each split by its word in reports/metrics and in the seeds of the random numbers, on which the results depend.
SPLITS: dict[str, str] = {Split.RANDOM: "anywhere", Split.REGIONS: "apart"}


def split_touches(
    truth: np.ndarray, places: np.ndarray, split: str, min_distance: float, random: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """(train, test) indices of touches (k,) with objects truth (k,) and places (k, 3), in rising order.

    A quarter of each object's touches is held out: `random`, so that test arrays overlap training arrays; or `regions`,
    one region of each object, where only touches farther than `min_distance` units from all of the region remain for
    training. Raises ValueError for an object without touches to train on.
    """
    if split not in SPLITS:
        raise ValueError(f"unknown split {split}: choose one of {', '.join(SPLITS)}")
    train, test = [], []
    for label in np.unique(truth):
        members = np.flatnonzero(truth == label)
        count = round(HOLDOUT * len(members))
        if split == Split.RANDOM:
            held_out, kept = np.split(random.permutation(members), [count])
        else:
            distances = np.linalg.norm(places[members][:, None] - places[members][None], axis=2)
            region, rest = np.split(np.argsort(distances[random.integers(len(members))], kind="stable"), [count])
            held_out, kept = members[region], members[rest[(distances[rest][:, region] > min_distance).all(axis=1)]]
        if len(held_out) == 0 or len(kept) == 0:
            raise ValueError(f"object {label} has too few touches ({len(members)}) to hold some out: {split}")
        test.append(np.sort(held_out))
        train.append(np.sort(kept))
    return np.concatenate(train), np.concatenate(test)
