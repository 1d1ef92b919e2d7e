"""One answer of two senses, and how far to trust each (beyond T5.5, whose network is fed one sense at a time).

All take and give numpy arrays. A row of NaN is a sense that says nothing; the other one then speaks alone.
"""

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.special import log_softmax, softmax

WIDEST = np.log(100)  # temperatures are sought between 1 and 100
BINS = 10  # of the calibration error


def probabilities(scores, temperature=1.0):
    """(n, k) f8: the softmax of scores (n, k) over a temperature; above 1 humbles a network that is too sure."""
    if not temperature > 0:
        raise ValueError(f"a temperature must be above 0, got {temperature}")
    return softmax(np.asarray(scores, dtype=np.float64) / temperature, axis=1)


def best_temperature(scores, labels):
    """The temperature under which the labels (n,) are most likely (Guo et al. 2017, On calibration of neural networks).

    scores (n, k) must be of items that did not train the network. It never changes which class comes first, and is 1 or
    more: where all of a few items are right, any sharper answer is likelier still, and the network would be believed
    even where it sees nothing. Raises ValueError for no items, or scores that are not finite.
    """
    scores, labels = np.asarray(scores, dtype=np.float64), np.asarray(labels)
    if not len(scores) or len(scores) != len(labels) or not np.isfinite(scores).all():
        raise ValueError(f"a temperature needs finite scores with their labels, got {scores.shape} and {labels.shape}")

    def surprise(logarithm):
        return -log_softmax(scores / np.exp(logarithm), axis=1)[np.arange(len(labels)), labels].mean()

    return float(np.exp(minimize_scalar(surprise, bounds=(0, WIDEST), method="bounded").x))


def calibration_error(chances, labels):
    """Mean gap between the first class's probability and how often it is right, in ten bins weighted by their size.

    chances (n, k), labels (n,). Guo et al. 2017, eq. 3.
    """
    sure, right = chances.max(axis=1), chances.argmax(axis=1) == np.asarray(labels)
    bins = np.minimum((sure * BINS).astype(int), BINS - 1)
    gaps = np.bincount(bins, weights=right, minlength=BINS) - np.bincount(bins, weights=sure, minlength=BINS)
    return float(np.abs(gaps).sum() / len(sure))


def certainty(chances):
    """(n,) in 0..1: one less the entropy as a share of its most; 1 where one class has all, 0 where all are equal."""
    logs = np.log(chances, out=np.zeros_like(chances), where=chances > 0)
    return 1 + (chances * logs).sum(axis=1) / np.log(chances.shape[1])


def mean(vision, touch):
    """Both senses count the same."""
    return (vision + touch) / 2


def product(vision, touch):
    """As if the senses erred independently and all classes were equally frequent: either can rule a class out."""
    joint = np.clip(vision, 1e-12, None) * np.clip(touch, 1e-12, None)
    return joint / joint.sum(axis=1, keepdims=True)


def entropy(vision, touch):
    """Each sense counts by its certainty."""
    weights = np.stack([certainty(vision), certainty(touch)]) + 1e-12  # two that know nothing count the same
    weights = (weights / weights.sum(axis=0))[..., None]
    return weights[0] * vision + weights[1] * touch


def surest(vision, touch):
    """The sense whose first class is the likelier speaks alone, of equals vision; HybridNet.predict does this."""
    return np.where((vision.max(axis=1) >= touch.max(axis=1))[:, None], vision, touch)


FUSIONS = {"mean": mean, "product": product, "entropy": entropy, "surest": surest}


def fuse(vision, touch, rule):
    """(n, k) f8: what both senses say together, of their probabilities (n, k) by one of FUSIONS.

    Where one says nothing (NaN) the other's stand; where both do, NaN. Raises ValueError for an unknown rule or shapes
    that differ.
    """
    if rule not in FUSIONS:
        raise ValueError(f"unknown fusion {rule!r}, known: {', '.join(FUSIONS)}")
    vision, touch = np.asarray(vision, dtype=np.float64), np.asarray(touch, dtype=np.float64)
    if vision.shape != touch.shape or vision.ndim != 2:
        raise ValueError(f"both senses need probabilities of one shape (n, k), got {vision.shape} and {touch.shape}")
    found = np.where(np.isnan(vision), touch, vision)
    both = ~np.isnan(vision).any(axis=1) & ~np.isnan(touch).any(axis=1)
    found[both] = FUSIONS[rule](vision[both], touch[both])
    return found


def accuracy(chances, labels):
    """Share of rows whose first class is right; a row that says nothing is wrong."""
    spoken = np.isfinite(chances).all(axis=1)
    return float((spoken & (np.nan_to_num(chances).argmax(axis=1) == np.asarray(labels))).mean())
