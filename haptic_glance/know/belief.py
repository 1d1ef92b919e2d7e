"""Belief over objects from touches: a kernel density as the likelihood, calibration, and predicted outcomes.

A calibrated belief of 95 % is correct 95 times in a hundred.
"""

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike
from scipy.special import log_softmax


@dataclass(frozen=True)
class Calibration:
    """The weight of touches: the sum of their log likelihoods is multiplied by weight * touches^-redundancy.

    weight is the inverse temperature of one touch (Guo and others, On calibration of modern neural networks, 2017).
    redundancy is what touches of one object have in common: 0 if they are independent, so that evidence adds up as in
    naive Bayes; 1 if a second touch adds no information.
    """

    weight: float
    redundancy: float

    def log_belief(self, log_likelihoods: np.ndarray, touches: ArrayLike) -> np.ndarray:
        """Log belief (..., classes) after `touches` touches with the summed log_likelihoods (..., classes)."""
        factor = self.weight * np.asarray(touches, dtype=np.float64) ** -self.redundancy
        return log_softmax(np.asarray(factor)[..., None] * log_likelihoods, axis=-1)


def calibrate(sequences: ArrayLike, truth: ArrayLike, redundancy: bool = True) -> Calibration:
    """The Calibration that maximises the likelihood of the true objects of sequences of touches.

    sequences (e, touches, classes): log likelihoods of touches, in the order of touching; truth (e,). All lengths of a
    sequence have equal weight. The touches must not be among those that the likelihood was fitted to. redundancy=False
    keeps the redundancy at 0 and fits the weight to single touches: the plain product.
    Raises ValueError for sequences that are empty or not finite, and for a truth that is no class of theirs.
    """
    sequences, truth = _checked(np.asarray(sequences, dtype=np.float64), np.asarray(truth))
    log_likelihoods = np.cumsum(sequences if redundancy else sequences[:, :1], axis=1)
    touches = np.arange(1, log_likelihoods.shape[1] + 1)

    def loss(values):
        log_belief = Calibration(np.exp(values[0]), values[1]).log_belief(log_likelihoods, touches)
        return -log_belief[np.arange(len(truth)), :, truth].mean()

    bounds = [(-4.0, 3.0), (0.0, 1.0 if redundancy else 0.0)]
    optimum = scipy.optimize.minimize(loss, [0.0, 0.5 if redundancy else 0.0], bounds=bounds, method="L-BFGS-B").x
    return Calibration(float(np.exp(optimum[0])), float(optimum[1]))


STEPS = [
    Calibration(weight, redundancy)
    for weight in np.geomspace(0.02, 2.5, 15).tolist()
    for redundancy in (0, 0.2, 0.4, 0.6, 0.8, 1)
]


def calibrate_to_stop(sequences: ArrayLike, truth: ArrayLike, sure: float, start: Calibration) -> Calibration:
    """The Calibration whose belief may end the touching: the object first believed at `sure` is right that often.

    A belief that is right on average at each number of touches errs more often at the touch at which it first passes
    `sure`: errors pass it, too. Returns `start` unless chance alone would hardly let it err that often. Otherwise
    returns the one of STEPS that holds and stops soonest; where none holds, the one that stops least.

    sequences, truth: as in `calibrate`. sure: probability from 0 to 1.
    """
    sequences, truth = _checked(np.asarray(sequences, dtype=np.float64), np.asarray(truth))
    log_likelihoods, touches = np.cumsum(sequences, axis=1), np.arange(1, sequences.shape[1] + 1)

    def stops(calibration):
        """(how many sequences stop, how many more of them are right than `sure` asks for, mean number of touches)."""
        belief = np.exp(calibration.log_belief(log_likelihoods, touches))
        passed = belief.max(axis=2) >= sure
        first, stopped = passed.argmax(axis=1), passed.any(axis=1)
        right = belief[np.arange(len(truth)), first].argmax(axis=1) == truth
        mean = np.where(stopped, touches[first], len(touches)).mean()
        return stopped.sum(), right[stopped].sum() - sure * stopped.sum(), mean

    count, margin, _ = stops(start)
    if margin >= -2 * np.sqrt(count * sure * (1 - sure)):  # two standard errors
        return start
    outcomes = [(step, *stops(step)) for step in STEPS]
    sound = [outcome for outcome in outcomes if outcome[1] and outcome[2] >= 0]
    return min(sound, key=lambda outcome: outcome[3])[0] if sound else min(outcomes, key=lambda outcome: outcome[1])[0]


def _checked(sequences, truth):
    """The two as they are; ValueError where no touch, or no number, would calibrate a belief."""
    if sequences.ndim != 3 or 0 in sequences.shape:
        shape = "(sequences, touches, classes), of each at least one"
        raise ValueError(f"sequences must have shape {shape}, got shape {sequences.shape}")
    if len(wrong := np.argwhere(~np.isfinite(sequences))):
        value, where = sequences[tuple(wrong[0])], wrong[0][0]
        raise ValueError(f"sequences must be finite log likelihoods, got {value} in sequence {where}")
    if truth.shape != sequences.shape[:1] or not np.isin(truth, np.arange(sequences.shape[2])).all():
        remedy = f"one class from 0 to {sequences.shape[2] - 1} for each of the {len(sequences)} sequences"
        raise ValueError(f"truth must hold {remedy}")
    return sequences, truth.astype(np.int64)


FEATURE_WIDTH = 0.6  # of twelve standardised components; 0.3 to 1 give the same single-touch likelihood within 6 %
PLACE_WIDTH = 0.05  # units: a third of the array, within which neighbouring touches are similar
FLOOR = 1e-30  # of a density that rounds to 0
ORDERS = 5  # random orders of each object's touches, at least, for a calibration
STOPS, LAST = 400, 30  # orders of all objects together, and touches of each, where touching ends by a calibration
BLOCK = 256  # touches compared at once, in the processor's cache


def feature_kernel(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(k, n): the similarity of components (k, d) and (n, d), exp(-distance / width).

    Exponential rather than normal, so that a touch unlike all training touches does not decide alone. By the likelihood
    of single held-out touches it is better than a normal kernel, naive Bayes and linear discriminants.
    """
    return np.exp(-distances(first, second) / FEATURE_WIDTH)


def place_kernel(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(k, n): the proximity of places (k, 3) and (n, 3), exp(-distance / width)."""
    return np.exp(-distances(first, second) / PLACE_WIDTH)


def log_likelihood(kernel: np.ndarray, truth: np.ndarray, counts: np.ndarray | None = None) -> np.ndarray:
    """(..., k, classes) log density of touches under each object, up to a constant.

    kernel (..., k, n): of the touches with the training touches, products of `feature_kernel` and, if places are used,
    `place_kernel`; 0 for a training touch that must not count. truth (n,): the objects of the training touches. counts
    (k, classes): the number of training touches of each object that count; all by default.
    """
    one_hot = np.eye(int(truth.max()) + 1)[truth]
    counts = np.maximum(one_hot.sum(axis=0) if counts is None else counts, 1)
    return np.log(np.maximum(kernel @ one_hot / counts, FLOOR))


def distances(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(k, n) Euclidean distances of points (k, d) and (n, d)."""
    squares = (first**2).sum(axis=1)[:, None] + (second**2).sum(axis=1)[None] - 2 * first @ second.T
    return np.sqrt(np.maximum(squares, 0))


MAX_NEIGHBOURS = 8  # known touches of an object near a place, as predictions for the place
NEIGHBOUR_WIDTH = 0.08  # units, half an array: within which a known touch predicts others


def nearest_outcomes(distances: np.ndarray, owners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(outcomes (k, classes, o): ids of the touches of each object nearest to a place, their probabilities).

    distances (k, n): of k places to the known touches, in units; owners (n,): the objects of these, from 0.
    """
    of_object = [np.flatnonzero(owners == label) for label in range(int(owners.max()) + 1)]
    count = min(MAX_NEIGHBOURS, *map(len, of_object))
    outcomes = np.stack(
        [ids[np.argsort(distances[:, ids], axis=1, kind="stable")[:, :count]] for ids in of_object], axis=1
    )
    nearest = np.take_along_axis(distances[:, None], outcomes.reshape(len(distances), 1, -1), axis=2).reshape(
        outcomes.shape
    )
    weights = np.exp(-(nearest - nearest[..., :1]) / NEIGHBOUR_WIDTH)
    return outcomes, weights / weights.sum(axis=-1, keepdims=True)
