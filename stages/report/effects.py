"""The effect of a claim on each of its data sets, with its interval, and the pooled one."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd
from scipy import stats

from stages.kit.pooling import Pooled, pool
from stages.kit.power import needed
from stages.kit.stats import interval, p_value
from stages.kit.units import by_unit

from .claims import Claim
from .differences import differences, invalid
from .results import NotRun, Results
from .validity import TOO_MANY

ALIKE = 0.05  # p-value of Cochran's Q below which sets differ


@dataclass(frozen=True)
class Effect:
    """The differences of a claim on one set, indexed by its `over`, in its unit; share: as `Claim.share`.

    refused: the causes of invalid pairs; pairs: the number of all pairs, 0 where the rows of a stage have no check.
    """

    dataset: str
    differences: pd.Series
    share: float
    refused: tuple[str, ...] = ()
    pairs: int = 0

    @property
    def testable(self) -> bool:
        """Whether at most a fifth of the pairs is invalid; else the differences are those of all pairs."""
        return len(self.refused) <= TOO_MANY * self.pairs

    @property
    def validity(self) -> str:
        """`12 of 50 pairs invalid: no point found (10), less than one ring kept (2)`; empty where all are valid."""
        if not self.refused:
            return ""
        causes = ", ".join(f"{cause} ({count})" for cause, count in Counter(self.refused).most_common())
        return f"{len(self.refused)} of {self.pairs} pairs invalid: {causes}"

    @cached_property
    def units(self) -> pd.Series:
        """The differences of the outermost units."""
        return by_unit(self.differences)

    @cached_property
    def interval(self) -> tuple[float, float, float]:
        """(mean, low, high) over the units; no ends (NaN) where their spread is unknown."""
        return interval(self.units, self.share)

    @cached_property
    def p_value(self) -> float:
        """Two-sided, of no effect."""
        return p_value(self.units, self.share)

    @property
    def most(self) -> int:
        """The number of units."""
        return len(self.units)

    @property
    def freedom(self) -> int:
        """Degrees of freedom of the interval."""
        return len(self.units) - 1

    @property
    def error(self) -> float:
        """The standard error that the interval stands for."""
        return (self.interval[2] - self.interval[1]) / 2 / float(stats.t.ppf(0.975, self.freedom))

    def needs(self, distance: float) -> float:
        """The number of units whose interval would be no wider than `distance` to either side."""
        return needed(float(self.units.std()), distance, self.share)


@dataclass(frozen=True)
class PooledEffect:
    """The effects of two sets or more with an interval each, and what they come to."""

    sets: Sequence[Effect]

    @cached_property
    def pooled(self) -> Pooled:
        """By random effects."""
        return pool(*zip(*((one.interval[0], one.error, one.freedom) for one in self.sets), strict=True))

    @property
    def interval(self) -> tuple[float, float, float]:
        """(mean, low, high) of the pooled effect."""
        return self.pooled.interval()

    @property
    def p_value(self) -> float:
        """Two-sided, of no pooled effect."""
        return self.pooled.p_value

    @property
    def in_each(self) -> bool:
        """Whether the interval of each set excludes zero on the same side."""
        _, low, high = np.transpose([one.interval for one in self.sets])
        return bool((low > 0).all() or (high < 0).all())

    @property
    def units(self) -> pd.Series:
        """The differences of the units of all sets."""
        return pd.concat([one.units for one in self.sets])

    @property
    def most(self) -> int:
        """The number of units of the largest set."""
        return max(one.most for one in self.sets)

    @property
    def disagree(self) -> bool:
        """Whether each side of zero has a set whose own interval excludes it, or sets of both signs differ by Q."""
        means, low, high = np.transpose([one.interval for one in self.sets])
        both_signs = means.min() < 0 < means.max()
        return bool((low > 0).any() and (high < 0).any()) or (both_signs and self.pooled.differ < ALIKE)

    def needs(self, distance: float) -> float:
        """The number of units of all sets, or of sets where these differ, whose interval would be no wider."""
        count = len(self.sets) if self.pooled.between > 0 else len(self.units)
        return needed(self.pooled.error * count**0.5, distance)


def sets_of(claim: Claim, results: Results) -> list[str | None]:
    """The data sets of a claim; for None the first with rows of the stage that it does not name, if there is any.

    Where no set has such rows, None stays, and is what a run would measure.
    """
    there = results.datasets(claim.stage)
    others = [name for name in there if name not in claim.sets]
    found = [name or next(iter(others), None) for name in claim.sets]
    return [name for name in found if name or not there]


def effects(claim: Claim, results: Results) -> tuple[list[Effect], list[str]]:
    """(the effect on each set that was measured, the names of the others).

    NotRun where none was: of a set that has rows of the stage, else of one that a run would measure.
    """
    found, missing = [], {}
    for name in sets_of(claim, results):
        try:
            found.append(_effect(claim.on(name), results, name or ""))
        except NotRun as error:
            missing[name or ""] = error
    if not found:
        there = results.datasets(claim.stage)
        raise max(missing.items(), key=lambda one: (one[0] in there, one[1].runnable))[1]
    return found, list(missing)


def _effect(claim: Claim, results: Results, name: str) -> Effect:
    """The effect on one set; of all pairs where too many of them are invalid."""
    causes, pairs = invalid(results, claim)
    if len(causes) > TOO_MANY * pairs:
        claim = replace(claim, checked=False)
    values = differences(results, claim).map(lambda value: float(f"{value:.6g}"))  # as it is written in a CSV
    return Effect(name, values, claim.share, tuple(causes), pairs)


def deciding(claim: Claim, found: Sequence[Effect], results: Results, strict: bool = False) -> list[Effect]:
    """The effects that give the verdict: those on sets as printed, else the first that was measured.

    strict: only those on sets as printed, of which there may be none.
    """
    printed = sets_of(claim, results)[: claim.judging]
    return [one for one in found if (one.dataset or None) in printed] or ([] if strict else list(found[:1]))


def effect_of(found: Sequence[Effect]) -> Effect | PooledEffect:
    """The pooled effect of all testable sets with an interval, or that of the only one."""
    known = [one for one in found if one.testable and np.isfinite(one.interval[1])]
    return PooledEffect(known) if len(known) > 1 else (known or found)[0]
