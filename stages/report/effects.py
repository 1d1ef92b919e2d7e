"""The effect of a claim on each of its data sets, with its interval, and the pooled one."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd
from scipy import stats

from stages.kit.pooling import Pooled, pool
from stages.kit.power import needed
from stages.kit.stats import interval, p_value
from stages.kit.units import by_unit

from .claims import Claim
from .differences import differences
from .results import NotRun, Results

ALIKE = 0.05  # p-value of Cochran's Q below which sets differ


@dataclass(frozen=True)
class Effect:
    """The differences of a claim on one set, indexed by its `over`, in its unit; share: as `Claim.share`."""

    dataset: str
    differences: pd.Series
    share: float

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
        """(mean, low, high) of the pooled effect.

        Where few sets differ it can be wider than all their own intervals together. Then it is cut to these: it is
        about these sets alone, and sets that all say the same decide even where they say it by different amounts.
        """
        mean, low, high = self.pooled.interval()
        _, lows, highs = zip(*(one.interval for one in self.sets), strict=True)
        return mean, max(low, min(lows)), min(high, max(highs))

    @property
    def p_value(self) -> float:
        """Two-sided, of no effect: of the pooled one, or of none in any of the sets where that is smaller."""
        return min(self.pooled.p_value, max(one.p_value for one in self.sets))

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
        one = claim.on(name)
        try:
            values = differences(results, one).map(lambda value: float(f"{value:.6g}"))  # as it is written in a CSV
            found.append(Effect(name or "", values, one.share))
        except NotRun as error:
            missing[name or ""] = error
    if not found:
        there = results.datasets(claim.stage)
        raise max(missing.items(), key=lambda one: (one[0] in there, one[1].runnable))[1]
    return found, list(missing)


def effect_of(found: Sequence[Effect]) -> Effect | PooledEffect:
    """The pooled effect of all sets with an interval, or that of the only one."""
    known = [one for one in found if np.isfinite(one.interval[1])]
    return PooledEffect(known) if len(known) > 1 else (known or found)[0]
