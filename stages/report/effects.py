"""Effects of claims: the paired differences on one data set, and their pooled effect over several.

A claim whose share of invalid pairs exceeds TOO_MANY cannot be tested (stages.report.validity).
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd
from scipy import special

from stages.engine.measurements import Measurements, Missing, listed
from stages.engine.rows import by_unit
from stages.engine.statistics import Pooled, interval, p_value, pool

from .claims import Claim, ClaimError
from .pairs import TOO_MANY, invalid, require_rows
from .statistics import STATISTICS

PAIR = 2  # units of a set whose spread says nothing
ALIKE = 0.05  # p-value of Cochran's Q below which sets differ


@dataclass(frozen=True)
class Effect:
    """The differences of a claim on one set, indexed by its `over`, in its unit; share: as `Claim.share`.

    refused: the causes of invalid pairs; pairs: the number of all pairs, 0 where none of them is invalid.
    """

    dataset: str
    differences: pd.Series
    share: float
    refused: tuple[str, ...] = ()
    pairs: int = 0

    @property
    def testable(self) -> bool:
        """Whether at most a fifth of the pairs is invalid."""
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
        return (self.interval[2] - self.interval[1]) / 2 / float(special.stdtrit(self.freedom, 0.975))


@dataclass(frozen=True)
class PooledEffect:
    """The effects of two or more sets with an interval each, and their pooled effect."""

    sets: Sequence[Effect]

    @cached_property
    def pooled(self) -> Pooled:
        """By random effects."""
        effects = zip(*((effect.interval[0], effect.error, effect.freedom) for effect in self.sets), strict=True)
        return pool(*effects)

    @property
    def interval(self) -> tuple[float, float, float]:
        """(mean, low, high) of the pooled effect."""
        return self.pooled.interval()

    @property
    def p_value(self) -> float:
        """Two-sided, of no pooled effect."""
        return self.pooled.p_value

    @property
    def units(self) -> pd.Series:
        """The differences of the units of all sets."""
        return pd.concat([effect.units for effect in self.sets])

    @property
    def disagree(self) -> bool:
        """Whether each side of zero has a set whose own interval excludes it, or sets of both signs differ by Q."""
        means, low, high = np.transpose([effect.interval for effect in self.sets])
        both_signs = means.min() < 0 < means.max()
        return bool((low > 0).any() and (high < 0).any()) or (both_signs and self.pooled.differ < ALIKE)


def effects(claim: Claim, results: Measurements) -> tuple[list[Effect], list[str]]:
    """(the effect on each set that was measured, the names of the others); Missing where none was measured."""
    set_effects, missing = [], {}
    for name in claim.sets:
        try:
            set_effects.append(_effect(replace(claim, sets=(name,)), results))
        except Missing as error:
            missing[name] = error
    if not set_effects:
        raise next(iter(missing.values()))
    return set_effects, list(missing)


def _effect(claim: Claim, results: Measurements) -> Effect:
    """The effect on one set, of its valid pairs, or of all pairs where none is valid."""
    (name,) = claim.sets
    causes, pairs = invalid(results, claim)
    try:
        values = differences(results, claim)
    except Missing:
        if not pairs:
            raise
        values = differences(results, replace(claim, checked=False))
    values = values.map(lambda value: float(f"{value:.6g}"))  # as it is written in a CSV
    return Effect(name, values, claim.share(name), tuple(causes), pairs)


def differences(results: Measurements, claim: Claim) -> pd.Series:
    """The differences of a claim on one set, in its unit, indexed by its `over`; Missing where there is no pair."""
    values = STATISTICS[claim.statistic](results, claim).dropna()
    require_rows(values, f"no pairs for {claim.key}")
    return claim.scale * values + claim.margin


def effect_of(measured: Sequence[Effect]) -> Effect | PooledEffect:
    """The pooled effect of all testable sets with an interval, or that of the only one; of all sets where none is.

    A set of two units is left out beside others: the spread of two is often tiny by luck, and would rule the mean.
    """
    testable = [effect for effect in measured if effect.testable] or measured  # else the numbers of all
    usable = [effect for effect in testable if np.isfinite(effect.interval[1])]
    usable = [effect for effect in usable if len(usable) == 1 or effect.most > PAIR] or usable
    return PooledEffect(usable) if len(usable) > 1 else (usable or testable)[0]


def check(claim: Claim, measurements: Measurements) -> None:
    """ClaimError where a claim or its readings name a statistic, metric or column that there is not, or lack rows."""
    if claim.statistic not in STATISTICS:
        raise ClaimError(f"{claim.place} ({claim.key}): statistic {claim.statistic} is unknown")
    for variant in (claim, *(reading.of(claim) for reading in claim.readings)):
        for dataset in variant.sets_read():
            for side in (variant.first, variant.second if isinstance(variant.second, Mapping) else {}):
                where = {**variant.where, **side}
                metrics = [name for name in listed(where.get("metric", ())) if isinstance(name, str)]
                try:
                    rows = measurements.rows(variant.stage, dataset, **({"metric": metrics} if metrics else {}))
                except Missing as missing:
                    raise ClaimError(f"{claim.place} ({claim.key}): {missing}") from missing
                columns = {*where, *variant.over, *variant.within} - {"dataset"}
                if unknown := sorted(columns - {*rows}):
                    raise ClaimError(f"{claim.place} ({claim.key}): no column {unknown[0]} in rows of {claim.stage}")
