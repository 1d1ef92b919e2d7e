"""Effects of claims: paired differences, and their pooled effect over the data sets.

`statistic` registers the functions that turn rows into paired differences. `Effect` holds the differences on one data
set, `PooledEffect` the random-effects mean over several. A claim whose share of invalid pairs exceeds TOO_MANY cannot
be tested (stages.report.validity).
"""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatch
from functools import cached_property
from importlib import import_module

import numpy as np
import pandas as pd
from scipy import stats

from stages.charts.results import NotRun, Results, either, listed, require_rows
from stages.engine.rows import by_unit
from stages.engine.statistics import Pooled, interval, needed, p_value, pool

from .claims import Claim, Pick, Side
from .validity import CHECKS, SAME, causes

STATISTICS: dict[str, Callable[[Results, Claim], pd.Series]] = {}


def statistic(name: str) -> Callable:
    """Registers a function(results, claim) -> Series of differences over the claim's units, before scaling."""
    return lambda function: STATISTICS.setdefault(name, function)


def differences(results: Results, claim: Claim) -> pd.Series:
    """The differences of a claim on one set, in its unit, indexed by its `over`; NotRun where nothing can be paired."""
    if claim.statistic not in STATISTICS:
        import_module(f"{__package__}.parts")  # a worker has not imported the topic that registers it
    values = STATISTICS[claim.statistic](results, claim).dropna()
    return claim.scale * require_rows(values, f"no pairs for {claim.key}", claim.stage, runnable=False) + claim.margin


@statistic("difference")
def difference(results: Results, claim: Claim) -> pd.Series:
    """First side minus second, with all that the fields of a Claim say."""
    parts = [_difference(results, claim, where) for where in claim.contrast or ({},)]
    return parts[0] - parts[1] if claim.contrast else parts[0]


@statistic("beyond_chance")
def beyond_chance(results: Results, claim: Claim) -> pd.Series:
    """First side minus second, both scaled so that guessing is 0 and certainty 1; their groups tell the chance."""
    scores, sides = [], (claim.first, claim.other)
    for selection, other in (sides, sides[::-1]):
        guess = 1 / results.classes(str({**claim.where, **selection}["group"]), claim.sets[0])
        scores.append((side(results, claim, selection, other) - guess) / (1 - guess))
    return scores[0] - scores[1]


def side(
    results: Results, claim: Claim, selection: Side, other: Side | float | None, extra: Side | None = None
) -> pd.Series:
    """Values of one side, indexed by over and within; of several named values the mean of those measured.

    other: the other side, whose values a Pick leaves out. extra: further columns that both sides have in common.
    """
    part = _side_rows(results, claim, selection, other, extra)
    if not part.keys:
        return part.rows["value"]
    values = part.means
    if part.several:
        cells = part.rows.groupby([*part.keys, *part.several], sort=False)["value"].mean()
        values = cells.unstack(part.several, sort=False).dropna().mean(axis=1)
    return values if part.invalid.empty else values.drop(part.invalid.index, errors="ignore")


def invalid_pairs(rows: pd.DataFrame, reasons: pd.Series, keys: Sequence[str]) -> pd.Series:
    """Causes of the pairs with an invalid row, indexed by the columns `keys`; reasons: as in `SideRows`."""
    bad = reasons[reasons != ""]
    return bad if bad.empty else bad.groupby([rows[key] for key in keys], sort=False).first()


def reasons_of(results: Results, claim: Claim, rows: pd.DataFrame) -> pd.Series:
    """The cause why a row is invalid, empty text for a valid row; no rows where a claim is not checked."""
    if not claim.checked or claim.stage not in CHECKS:
        return pd.Series(dtype=object)
    return causes(results, claim.stage, str(rows["dataset"].iloc[0]), rows)


def invalid(results: Results, claim: Claim) -> tuple[pd.Series, int]:
    """(the cause of each invalid pair, number of all pairs) of a claim on one set, before a unit's pairs are averaged.

    The number is 0 where no pair is invalid. A statistic of its own pairs by object and target, as
    stages.report.meshes.claims does.
    """
    if not claim.checked or claim.stage not in CHECKS:
        return pd.Series(dtype=object), 0
    keys = [*claim.over, *claim.within]
    if claim.statistic != "difference":
        keys += ["target"] if claim.stage == "lod" and "target" not in keys else []
    named_sides = {"first": claim.first, "second": claim.second}  # a side that counts by its mean has no pairs
    sides = [side for name, side in named_sides.items() if isinstance(side, Mapping) and name != claim.mean_of]
    contrasts: list[tuple[list[pd.DataFrame], pd.Series]] = []
    for extra in claim.contrast or ({},):
        side_rows = [_side_rows(results, claim, selection, sides[1 - k] if len(sides) > 1 else None, extra)
                 for k, selection in enumerate(sides)]  # fmt: skip
        parts = [part.rows for part in side_rows]
        bad = [part.invalid if part.keys == keys else invalid_pairs(part.rows, part.reasons, keys)
               for part in side_rows]  # fmt: skip
        if len(parts) > 1 and claim.statistic == "difference" and claim.stage == "lod":
            first, second = (part.means for part in side_rows)
            pair_means = both_sides(first, second)
            bad.append(pd.Series(SAME, index=pair_means.index[_same_mesh(claim, pair_means)], dtype=object))
        bad = [causes for causes in bad if len(causes)]
        contrasts.append((parts, pd.concat(bad) if bad else pd.Series(dtype=object)))
    if all(bad.empty for _, bad in contrasts):
        return pd.Series(dtype=object), 0
    common = [set.intersection(*(_pairs(part, keys) for part in parts)) for parts, _ in contrasts]
    valid = (bad[~bad.index.duplicated()] for _, bad in contrasts)
    pair_causes = [bad[[pair in pairs for pair in bad.index]] for pairs, bad in zip(common, valid, strict=True)]
    return pd.concat(pair_causes), sum(map(len, common))


def _pairs(rows: pd.DataFrame, keys: list[str]) -> set:
    """The combinations of the columns, as an index of these columns has them: bare values of a single column."""
    return set(rows[keys[0]]) if len(keys) == 1 else set(zip(*(rows[key] for key in keys), strict=True))


def both_sides(first: pd.Series, second: pd.Series) -> pd.DataFrame:
    """Columns first and second of the pairs that both sides have, in the order of the first side."""
    if first.index.equals(second.index):
        return pd.DataFrame({"first": first.array, "second": second.array}, index=first.index)
    places = second.index.get_indexer(first.index)
    has_both = places >= 0
    columns = {"first": first.array[has_both], "second": second.array[places[has_both]]}
    return pd.DataFrame(columns, index=first.index[has_both])


def _same_mesh(claim: Claim, joined: pd.DataFrame) -> pd.Series:
    """(pairs,) whether two simplifications have errors that are equal to the last digit, and not zero."""
    if claim.stage != "lod" or not claim.checked or claim.ties:
        return pd.Series(False, index=joined.index)
    return (joined["first"] == joined["second"]) & (joined["first"] > 0)


@dataclass(frozen=True)
class SideRows:
    """The rows of one side of a claim; several: the columns over whose several values the side is a mean.

    keys: the columns that name a pair. reasons: the cause why a row is invalid, empty text for a valid row; empty where
    a claim is not checked.
    """

    rows: pd.DataFrame
    keys: list[str]
    several: list[str]
    reasons: pd.Series

    @cached_property
    def means(self) -> pd.Series:
        """The mean value of each pair."""
        return self.rows.groupby(self.keys, sort=False)["value"].mean()

    @cached_property
    def invalid(self) -> pd.Series:
        """The cause of each invalid pair."""
        return invalid_pairs(self.rows, self.reasons, self.keys)


def _side_rows(
    results: Results, claim: Claim, selection: Side, other: Side | float | None, extra: Side | None
) -> SideRows:
    """The SideRows of a selection, which the check of a claim and its difference both ask for."""
    where = {**claim.where, **(extra or {}), **selection}
    dataset = where.pop("dataset", claim.sets[0])
    keys = (*claim.over, *claim.within)
    query = (claim.stage, dataset, keys, claim.checked, repr(where), repr(other))
    return results.cached(query, lambda: _select(results, claim, where, dataset, other))


def _select(
    results: Results, claim: Claim, where: dict[str, object], dataset: str | None, other: Side | float | None
) -> SideRows:
    picks = {column: value for column, value in where.items() if isinstance(value, Pick)}
    patterns = {column: value for column, value in where.items() if isinstance(value, str) and "*" in value}
    plain = {column: value for column, value in where.items() if column not in picks | patterns}
    rows = results.measured(claim.stage, dataset, **plain)
    for column, value in patterns.items():
        rows = _some(rows[[fnmatch(str(name), value) for name in rows[column]]], claim, f"{column} like {value}")
    for column, value in picks.items():
        parts = [rows]
        if claim.contrast:  # one method in both parts, by what the contrast is of
            parts = [results.measured(claim.stage, dataset, **{**plain, **part}) for part in claim.contrast]
        valid = [_mostly_valid(part, column, reasons_of(results, claim, part)) for part in parts]
        try:
            choice = _picked(valid, claim, column, value, other)
        except NotRun:
            choice = _picked(parts, claim, column, value, other)
        rows = rows[rows[column] == choice]
    keys = [*claim.over, *claim.within]
    for column in keys:
        if column not in rows:
            raise NotRun(f"no column {column} in the rows of {claim.stage}", claim.stage)
    several = [k for k, v in where.items() if k not in keys and (isinstance(v, tuple) or k in patterns)]
    return SideRows(rows, keys, several, reasons_of(results, claim, rows))


def _difference(results: Results, claim: Claim, extra: Side) -> pd.Series:
    if isinstance(claim.second, int | float):
        values = side(results, claim, claim.first, None, extra) - claim.second
    else:
        pooled = replace(claim, over=(), within=())  # all rows of a side, also those about no unit
        first, second = (
            side(results, pooled if claim.mean_of == name else claim, selection, other, extra)
            for name, selection, other in (("first", claim.first, claim.other), ("second", claim.other, claim.first))
        )
        if claim.mean_of:
            values = first.mean() - second if claim.mean_of == "first" else first - second.mean()
        else:
            side_values = both_sides(first, second)
            is_same = _same_mesh(claim, side_values)
            side_values = side_values[~is_same] if is_same.any() else side_values
            names = " and ".join(" ".join(map(either, columns.values())) for columns in (claim.first, claim.other))
            require_rows(side_values, f"no pairs of {names}", claim.stage, runnable=False)
            values = side_values["first"] - side_values["second"]
            if claim.relative:
                middle = (side_values["first"] + side_values["second"]) / 2
                values /= middle.where(middle > 0, 1.0)  # two errors of zero are equal
    return values.groupby(level=list(range(len(claim.over))), sort=False).mean() if claim.within else values


def _mostly_valid(rows: pd.DataFrame, column: str, reasons: pd.Series) -> pd.DataFrame:
    """The valid rows of the values of a column that have enough of them: refused rows make no method the best."""
    if reasons.empty:
        return rows
    refused = (reasons != "").groupby(rows[column]).transform("mean")
    return rows[(reasons == "") & (refused <= TOO_MANY)]


def _picked(parts: Sequence[pd.DataFrame], claim: Claim, column: str, pick: Pick, other: Side | float | None) -> object:
    """The value that a Pick chooses by its mean in the rows, or by the first part's minus the second's."""
    rival = other.get(column) if isinstance(other, dict) else None
    out, tables = [*pick.but, *listed(rival or ())], []
    for rows in parts:
        _some(rows, claim, column)
        rows = rows[[not any(fnmatch(str(name), str(pattern)) for pattern in out) for name in rows[column]]]
        rows = rows[rows[column].isin(pick.names)] if pick.names else rows
        _some(rows, claim, f"other {column} than {either(out)}" if out else column)
        cells = rows.groupby([*claim.over, *claim.within, column], sort=False)["value"].mean()
        tables.append(cells.unstack(column, sort=False))
    table = tables[0] if len(tables) == 1 else (tables[0] - tables[1]).dropna(axis=1, how="all")
    _some(table, claim, f"{column} in both parts")
    averages = (table if table.dropna().empty else table.dropna()).mean()  # over the pairs that all of them have
    return averages.idxmin() if pick.lowest else averages.idxmax()


def _some(rows: pd.DataFrame, claim: Claim, subject: str) -> pd.DataFrame:
    return require_rows(rows, f"no {subject} is among those that {claim.stage} measured", claim.stage, runnable=False)


TOO_MANY = 0.2  # share of invalid pairs from which a claim cannot be tested
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
        return (self.interval[2] - self.interval[1]) / 2 / float(stats.t.ppf(0.975, self.freedom))

    def needs(self, distance: float) -> float:
        """The number of units whose interval would be no wider than `distance` to either side."""
        return needed(float(self.units.std()), distance, self.share)


@dataclass(frozen=True)
class PooledEffect:
    """The effects of two or more sets with an interval each, and their pooled effect.

    fixed: whether the mean of these sets is asked for, and not that of any sets.
    """

    sets: Sequence[Effect]
    fixed: bool = False

    @cached_property
    def pooled(self) -> Pooled:
        """By random effects, or the mean of these sets."""
        effects = zip(*((effect.interval[0], effect.error, effect.freedom) for effect in self.sets), strict=True)
        return pool(*effects, fixed=self.fixed)

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
        _, low, high = np.transpose([effect.interval for effect in self.sets])
        return bool((low > 0).all() or (high < 0).all())

    @property
    def units(self) -> pd.Series:
        """The differences of the units of all sets."""
        return pd.concat([effect.units for effect in self.sets])

    @property
    def most(self) -> int:
        """The number of units of the largest set."""
        return max(effect.most for effect in self.sets)

    @property
    def disagree(self) -> bool:
        """Whether each side of zero has a set whose own interval excludes it, or sets of both signs differ by Q.

        Sets whose mean is asked for may differ.
        """
        if self.fixed:
            return False
        means, low, high = np.transpose([effect.interval for effect in self.sets])
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
    datasets = results.datasets(claim.stage)
    unnamed = [name for name in datasets if name not in claim.sets]
    names = [name or next(iter(unnamed), None) for name in claim.sets]
    return [name for name in names if name or not datasets]


def effects(claim: Claim, results: Results, judged_sets: bool = False) -> tuple[list[Effect], list[str]]:
    """(the effect on each set that was measured, the names of the others).

    judged_sets: only the sets whose rows give the verdict. NotRun where none was measured: of a set that has rows of
    the stage, else of one that a run would measure.
    """
    set_effects, missing = [], {}
    for name in sets_of(claim, results)[: claim.judging if judged_sets else None]:
        try:
            set_effects.append(_effect(claim.on(name), results, name or ""))
        except NotRun as error:
            missing[name or ""] = error
    if not set_effects:
        datasets = results.datasets(claim.stage)
        raise max(missing.items(), key=lambda entry: (entry[0] in datasets, entry[1].runnable))[1]
    return set_effects, list(missing)


def _effect(claim: Claim, results: Results, name: str) -> Effect:
    """The effect on one set, of its valid pairs, or of all pairs where none is valid."""
    causes, pairs = invalid(results, claim)
    try:
        values = differences(results, claim)
    except NotRun:
        if not pairs:
            raise
        values = differences(results, replace(claim, checked=False))
    values = values.map(lambda value: float(f"{value:.6g}"))  # as it is written in a CSV
    return Effect(name, values, claim.share, tuple(causes), pairs)


def deciding(claim: Claim, measured: Sequence[Effect], results: Results, strict: bool) -> list[Effect]:
    """The effects that give the verdict: those on sets as printed, else the first that was measured.

    strict: only those on sets as printed, of which there may be none.
    """
    printed = sets_of(claim, results)[: claim.judging]
    printed_effects = [effect for effect in measured if (effect.dataset or None) in printed]
    return printed_effects if printed_effects or strict else list(measured[:1])


def effect_of(measured: Sequence[Effect], fixed: bool = False) -> Effect | PooledEffect:
    """The pooled effect of all testable sets with an interval, or that of the only one; of all sets where none is.

    A set of two units is left out beside others: the spread of two is often tiny by luck, and would rule the mean.
    """
    testable = [effect for effect in measured if effect.testable] or measured  # else the numbers of all
    usable = [effect for effect in testable if np.isfinite(effect.interval[1])]
    usable = [effect for effect in usable if len(usable) == 1 or effect.most > PAIR] or usable
    return PooledEffect(usable, fixed) if len(usable) > 1 else (usable or testable)[0]
