"""Random-effects pooling: one effect from those of several data sets, and how much the sets differ."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import stats

ROUNDS = 1000  # of the search for the variance between sets; tens are enough but where it is next to zero


class Pooled(NamedTuple):
    """A pooled effect: its standard error with degrees of freedom, and how the sets vary.

    between: the variance between sets. i2: its share of the variation of the sets' effects, 0 to 1. differ: p-value of
    Cochran's Q, that all sets have one effect.
    """

    mean: float
    error: float
    freedom: float
    between: float
    i2: float
    differ: float

    def interval(self, level: float = 0.95) -> tuple[float, float, float]:
        """(mean, low, high), by Student's t."""
        half = float(stats.t.ppf((1 + level) / 2, self.freedom)) * self.error
        return self.mean, self.mean - half, self.mean + half

    @property
    def p_value(self) -> float:
        """Two-sided, of no effect."""
        return float(2 * stats.t.sf(abs(self.mean) / self.error, self.freedom))


def pool(means: Sequence[float], errors: Sequence[float], freedoms: Sequence[float]) -> Pooled:
    """The random-effects mean of the effects of k sets, (k,) with their standard errors and degrees of freedom.

    The variance between sets is that of restricted maximum likelihood. Where it is above zero and there are three sets
    or more, the error is Hartung and Knapp's (2001) with k - 1 degrees of freedom: it carries to other sets. That error
    is too small where sets agree by luck, and therefore never taken below the plain one (Roever, Knapp and Friede,
    BMC Medical Research Methodology 2015). Else the error is the plain one, sqrt(1 / sum of weights), with the degrees
    of freedom of Welch and Satterthwaite. Of two sets nobody knows the spread of sets: it is about these two. Raises
    ValueError for fewer than two sets, or an error that is not above zero.
    """
    effects, within = np.asarray(means, dtype=np.float64), np.asarray(errors, dtype=np.float64) ** 2
    k = len(effects)
    if k < 2 or not (within > 0).all():
        raise ValueError(f"pooling needs two sets or more with errors above zero, got the errors {list(errors)}")
    weights = 1 / within
    q = float(weights @ (effects - weights @ effects / weights.sum()) ** 2)
    typical = (k - 1) / (weights.sum() - (weights**2).sum() / weights.sum())  # variance within (Higgins, Thompson 2002)
    between = variance_between(effects, within)
    weights = 1 / (within + between)
    mean = float(weights @ effects / weights.sum())
    error, freedom = weights.sum() ** -0.5, weights.sum() ** 2 / (weights**2 / np.asarray(freedoms)).sum()
    if between > 0 and k > 2:
        error, freedom = error * max(1.0, float(weights @ (effects - mean) ** 2) / (k - 1)) ** 0.5, k - 1
    shares = between / (between + typical), stats.chi2.sf(q, k - 1)
    return Pooled(mean, float(error), float(freedom), between, *map(float, shares))


def variance_between(effects: np.ndarray, within: np.ndarray) -> float:
    """The variance between sets by restricted maximum likelihood (Viechtbauer 2005); effects, within: (k,)."""
    found = float(effects.var(ddof=1))
    for _ in range(ROUNDS):
        weights, before = 1 / (within + found), found
        mean = weights @ effects / weights.sum()
        step = (weights**2 @ ((effects - mean) ** 2 - within)) / (weights**2).sum() + 1 / weights.sum()
        found = max(0.0, float(step))
        if abs(found - before) <= 1e-9 * (found + within.min()):
            break
    return found if found > 1e-6 * within.min() else 0.0
