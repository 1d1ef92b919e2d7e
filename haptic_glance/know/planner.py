"""The next touch: where the name of the object is expected to be least uncertain afterwards."""

import numpy as np

CANDIDATES, TRUTHS = 160, 40  # hypotheses drawn from the belief; those of them in turn taken to be true
LEAST = 1e-12  # of a probability, in logarithms


def draw(weights: np.ndarray, count: int, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """(ids, shares): `count` draws by weights (n,), evenly spread; an id occurs once, with its share of the draws."""
    ends = np.cumsum(weights)
    places = (np.arange(count) + random.random()) / count * ends[-1]
    ids, counts = np.unique(np.minimum(np.searchsorted(ends, places), len(weights) - 1), return_counts=True)
    return ids, counts / count


def expected_entropy(
    names: np.ndarray,
    shares: np.ndarray,
    truths: np.ndarray,
    truth_shares: np.ndarray,
    log_likelihoods: np.ndarray,
) -> np.ndarray:
    """(lines,) expected entropy of the name, in nats, after a touch along each line.

    names (n,): numbers of the names of n hypotheses, with shares (n,) of the belief. truths (t,): those of them that
    are in turn taken to be true, with truth_shares (t,). log_likelihoods (lines, t, n): of each hypothesis, for the
    touch along a line if a truth is true (Lindley, On a measure of the information provided by an experiment, 1956).
    """
    weights = np.exp(log_likelihoods - log_likelihoods.max(axis=2, keepdims=True)) * shares
    _, numbers = np.unique(names, return_inverse=True)
    order = np.argsort(numbers, kind="stable")
    starts = np.flatnonzero(np.diff(numbers[order], prepend=-1))
    of_names = np.add.reduceat(weights[:, :, order], starts, axis=2)
    of_names /= of_names.sum(axis=2, keepdims=True)
    entropies = -(of_names * np.log(of_names + LEAST)).sum(axis=2)
    return entropies @ truth_shares
