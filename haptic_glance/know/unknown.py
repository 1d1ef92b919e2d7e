"""Objects that were never learned: the probability that touches are of the likeliest known object, or of none.

Two properties of the touches are compared with those of the likeliest object. The comparison is calibrated on the known
objects alone: each of them is left out in turn, and is then an unknown object among the others.
"""

from dataclasses import dataclass, replace

import numpy as np
import scipy
from scipy.special import expit, log_expit

from .belief import BLOCK, FLOOR, LAST, ORDERS, STOPS, Calibration, distances

NONE = "none of these"  # the answer where the object is not among the known ones
FEWEST, LEAST = 3, 4  # known objects: two remain where one is left out; touches of each
WIDTH = 2.0  # of `similarity`; 0.6 tells unknown objects in unknown poses less well, 5 no better
SCALES = np.geomspace(1.0, 0.1, 24).tolist()  # of the log odds, where sure answers are wrong too often


@dataclass(frozen=True)
class Verification:
    """Log odds after n touches that the object is known: scale n^growth (bias + fit excess - spread discrepancy).

    excess: the mean log likelihood ratio of the touches between the likeliest object and all known objects pooled (the
    background model of Reynolds and others, Speaker verification using adapted Gaussian mixture models, 2000), minus
    that of the object's own touches. discrepancy: the squared maximum mean discrepancy between the touches and those of
    the object (Gretton and others, A kernel two-sample test, 2012), over the mean similarity within both.
    """

    bias: float
    fit: float
    spread: float
    growth: float
    scale: float = 1.0

    def probability(self, excess: np.ndarray, discrepancy: np.ndarray, touches: np.ndarray) -> np.ndarray:
        """Probability that the object is known; all arguments broadcast."""
        return expit(self.log_odds(excess, discrepancy, touches))

    def log_odds(self, excess: np.ndarray, discrepancy: np.ndarray, touches: np.ndarray) -> np.ndarray:
        """Log odds that the object is known; all arguments broadcast."""
        evidence = self.bias + self.fit * excess - self.spread * discrepancy
        return self.scale * touches**self.growth * evidence


@dataclass(frozen=True)
class Sequences:
    """Sequences of touches, half of them of left-out objects; all (e, n), after 2 to n + 1 touches, but known (e,).

    excess, discrepancy: as in Verification. belief: in the likeliest object, if the object is one of the known. right:
    whether it is the likeliest.
    """

    excess: np.ndarray
    discrepancy: np.ndarray
    belief: np.ndarray
    right: np.ndarray
    known: np.ndarray


def fit_verification(sequences: Sequences, sure: float) -> Verification:
    """The Verification of the greatest likelihood, by logistic regression; all lengths of a sequence have equal weight.

    Log odds that are right on average are wrong more often at the touch at which an answer is first `sure`. The log
    odds are therefore scaled down until that share of the sure names, and of the sure answers `none`, is right, but
    for two standard errors.
    """
    touches = np.arange(2.0, sequences.excess.shape[1] + 2)
    signs = np.where(sequences.known, 1, -1)[:, None]

    def loss(values):
        log_odds = Verification(*values).log_odds(sequences.excess, sequences.discrepancy, touches)
        return -log_expit(signs * log_odds).mean()

    bounds = [(-3, 3), (0, 20), (0, 500), (0, 1.5)]
    fitted = scipy.optimize.minimize(loss, [0.1, 0.3, 1.0, 0.7], bounds=bounds, method="L-BFGS-B").x
    choices = [replace(Verification(*fitted.tolist()), scale=scale) for scale in SCALES]
    return next((choice for choice in choices if _may_stop(sequences, choice, sure)), choices[-1])


def _may_stop(sequences, choice, sure):
    """Whether the names, and the answers `none`, that are first sure are right often enough."""
    touches = np.arange(2.0, sequences.excess.shape[1] + 2)
    is_known = choice.probability(sequences.excess, sequences.discrepancy, touches)
    named, none = sequences.belief * is_known >= sure, 1 - is_known >= sure
    first, rows = (named | none).argmax(axis=1), np.arange(len(named))
    is_name, is_none = named[rows, first], none[rows, first]
    for answered, right in ((is_name, sequences.right[rows, first]), (is_none, ~sequences.known)):
        count = answered.sum()
        if right[answered].sum() - sure * count < -2 * np.sqrt(count * sure * (1 - sure)):
            return False
    return True


def similarity(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(k, n): the similarity of components (k, d) and (n, d), by a kernel that tells any two distributions apart."""
    return np.exp(-distances(first, second) / WIDTH)


def log_pooled(evidence: np.ndarray) -> np.ndarray:
    """(...) log likelihoods of touches under all objects pooled, from those under each (..., classes)."""
    return scipy.special.logsumexp(evidence, axis=-1) - np.log(evidence.shape[-1])


def check_unknown(objects: int, touches: int) -> None:
    """Raises ValueError unless there are enough objects, and touches of each, to tell unknown objects."""
    if objects < FEWEST or touches < LEAST:
        raise ValueError(
            f"the answer {NONE!r} (unknown=True) needs {FEWEST} objects or more, with {LEAST} touches or more of each, "
            f"got {objects} with {touches}: each object is left out in turn, as an example of an unknown one"
        )


class Verifier:
    """Tells touches of the likeliest known object from touches of an object that was never learned.

    evidence (classes, touches, classes): log likelihoods of the learned touches, each without itself; components
    (classes, touches, d): of these; calibration, sure: of the belief in one of the known objects; random: draws the
    orders of the touches. The numbers must pass `check_unknown`.
    """

    def __init__(
        self,
        evidence: np.ndarray,
        components: np.ndarray,
        calibration: Calibration,
        sure: float,
        random: np.random.Generator,
    ) -> None:
        classes = len(evidence)
        self._components, self._evidence, self._calibration = components, evidence, calibration
        self._kernels = np.stack([similarity(own, own) for own in components])
        self._within = _mean_of_pairs(self._kernels)
        own = evidence[np.arange(classes), :, np.arange(classes)]
        self._typical = (own - log_pooled(evidence)).mean(axis=1)
        self.verification = fit_verification(self._sequences(own, max(STOPS // classes, ORDERS), random), sure)

    def probability(self, log_likelihoods: np.ndarray, pooled: float, components: np.ndarray) -> float:
        """The probability that touches are of the likeliest known object; 0.5 before the second touch.

        log_likelihoods (classes,): sums over the touches; pooled: the sum of their `log_pooled`; components (touches,
        d): of these.
        """
        touches, best = len(components), int(log_likelihoods.argmax())
        if touches < 2:
            return 0.5
        excess = (log_likelihoods[best] - pooled) / touches - self._typical[best]
        across = similarity(components, self._components[best]).mean()
        within = _mean_of_pairs(similarity(components, components)) + self._within[best]
        parts = (np.asarray(part, dtype=float) for part in (excess, (within - 2 * across) / within, touches))
        return float(self.verification.probability(*parts))

    def _sequences(self, own, orders, random):
        """Sequences of the learned touches: each order once with its object known, and once with it left out."""
        classes, touches = own.shape
        count, across = min(LAST, touches // 2), self._across()
        without = _pooled_without(self._evidence)
        typical_without = (own[..., None] - without).mean(axis=1)  # (classes, the object that is left out)
        parts = []
        for label in np.repeat(np.arange(classes), orders):
            felt, rest = np.split(random.permutation(touches), [count])
            kernel, near, within = self._kernels[label], across[label, felt], self._within.copy()
            near[:, label], within[label] = (
                kernel[np.ix_(felt, rest)].mean(axis=1),
                _mean_of_pairs(kernel[np.ix_(rest, rest)]),
            )
            discrepancies = _discrepancies(kernel[np.ix_(felt, felt)], near, within)
            scores = self._evidence[label, felt]
            pools = (log_pooled(scores), self._typical), (without[label, felt, label], typical_without[:, label])
            for left_out, (pooled, typical) in enumerate(pools):
                parts.append((*self._features(scores, pooled, typical, discrepancies, label, left_out), not left_out))
        return Sequences(*map(np.array, zip(*parts, strict=True)))

    def _features(self, scores, pooled, typical, discrepancies, label, left_out):
        """(excess, discrepancy, belief, right) (n,) of touches with log likelihoods (n + 1, classes)."""
        touches, sums = np.arange(1, len(scores) + 1), np.cumsum(scores, axis=0)
        if left_out:
            sums[:, label] = -np.inf
        best, rows = sums.argmax(axis=1), np.arange(len(scores))
        belief = np.exp(self._calibration.log_belief(sums, touches)[rows, best])
        excess = (sums[rows, best] - np.cumsum(pooled)) / touches - typical[best]
        right = (best == label) & (not left_out)
        return tuple(values[1:] for values in (excess, discrepancies[rows, best], belief, right))

    def _across(self):
        """(classes, touches, classes): mean similarity of each learned touch with those of each object."""
        classes, touches, dimensions = self._components.shape
        flat = self._components.reshape(-1, dimensions)
        parts = [
            similarity(flat[start : start + BLOCK], flat).reshape(-1, classes, touches).mean(axis=2)
            for start in range(0, len(flat), BLOCK)
        ]
        return np.concatenate(parts).reshape(classes, touches, classes)


def _discrepancies(kernel, near, within):
    """(k, classes): the discrepancy after each of k touches, from their kernel (k, k) and (k, classes) `near`."""
    touches = np.arange(1, len(kernel) + 1)
    pairs = np.cumsum(np.tril(kernel, -1).sum(axis=1)) * 2 / np.maximum(touches * (touches - 1), 1)
    both = pairs[:, None] + within
    return (both - 2 * np.cumsum(near, axis=0) / touches[:, None]) / both


def _mean_of_pairs(kernel):
    """(...) mean of kernels (..., k, k) over pairs of different touches."""
    count = kernel.shape[-1]
    return (kernel.sum(axis=(-2, -1)) - np.trace(kernel, axis1=-2, axis2=-1)) / (count * (count - 1))


def _pooled_without(evidence):
    """(classes, touches, classes): log likelihoods under all objects pooled but one, the last index."""
    highest = evidence.max(axis=-1, keepdims=True)
    shares = np.exp(evidence - highest)
    others = np.maximum(shares.sum(axis=-1, keepdims=True) - shares, FLOOR)
    return highest + np.log(others / (evidence.shape[-1] - 1))
