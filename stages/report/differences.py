"""The paired differences of a claim, from its rows: one registry of statistics."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fnmatch import fnmatch
from importlib import import_module

import pandas as pd

from .claims import Claim, Pick, Side
from .results import Results, either, listed, some
from .validity import CHECKS, SAME, causes

STATISTICS: dict[str, Callable[[Results, Claim], pd.Series]] = {}


def statistic(name: str) -> Callable:
    """Registers a function(results, claim) -> Series of differences over the claim's units, before scaling."""
    return lambda function: STATISTICS.setdefault(name, function)


def differences(results: Results, claim: Claim) -> pd.Series:
    """The differences of a claim on one set, in its unit, indexed by its `over`; NotRun where nothing can be paired."""
    if claim.statistic not in STATISTICS:
        import_module(f"{__package__}.topics")  # a worker has not imported the topic that registers it
    found = STATISTICS[claim.statistic](results, claim).dropna()
    return claim.scale * some(found, f"no pairs for {claim.key}", claim.stage, runnable=False) + claim.margin


@statistic("difference")
def difference(results: Results, claim: Claim) -> pd.Series:
    """First side minus second, with all that the fields of a Claim say."""
    found = [_difference(results, claim, where) for where in claim.contrast or ({},)]
    return found[0] - found[1] if claim.contrast else found[0]


@statistic("beyond_chance")
def beyond_chance(results: Results, claim: Claim) -> pd.Series:
    """First side minus second, both scaled so that guessing is 0 and certainty 1; their groups tell the chance."""
    scores, sides = [], (claim.first, claim.other)
    for one, other in (sides, sides[::-1]):
        guess = 1 / results.classes(str({**claim.where, **one}["group"]), claim.sets[0])
        scores.append((side(results, claim, one, other) - guess) / (1 - guess))
    return scores[0] - scores[1]


def side(results: Results, claim: Claim, own: Side, other: Side | float | None, extra: Side | None = None) -> pd.Series:
    """Values of one side, indexed by over and within; of several named values the mean of those measured.

    other: the other side, whose values a Pick leaves out. extra: further columns that both sides have in common.
    """
    rows, several = _side_rows(results, claim, own, other, extra)
    keys = [*claim.over, *claim.within]
    if not keys:
        return rows["value"]
    if several:
        table = rows.pivot_table(index=keys, columns=several, values="value", sort=False)
        found = table.dropna().mean(axis=1)
    else:
        found = rows.groupby(keys, sort=False)["value"].mean()
    return found.drop(invalid_pairs(results, claim, rows).index, errors="ignore")


def invalid_pairs(results: Results, claim: Claim, rows: pd.DataFrame, keys: Sequence[str] = ()) -> pd.Series:
    """Causes of the pairs of a claim of which one of the rows is invalid, indexed by keys, else by over and within."""
    if not claim.checked or claim.stage not in CHECKS:
        return pd.Series(dtype=object)
    found = causes(results, claim.stage, str(rows["dataset"].iloc[0]), rows)
    return found[found != ""].groupby([rows[key] for key in keys or (*claim.over, *claim.within)], sort=False).first()


def invalid(results: Results, claim: Claim) -> tuple[pd.Series, int]:
    """(the cause of each invalid pair, number of all pairs) of a claim on one set, before a unit's pairs are averaged.

    A statistic of its own pairs by object and target, as stages.report.meshes.lod_claims does.
    """
    if not claim.checked or claim.stage not in CHECKS:
        return pd.Series(dtype=object), 0
    keys, found, count = [*claim.over, *claim.within], [], 0
    if claim.statistic != "difference":
        keys += ["target"] if claim.stage == "lod" and "target" not in keys else []
    sides = [side for side in (claim.first, claim.second) if isinstance(side, Mapping)]
    for extra in claim.contrast or ({},):
        parts = [_side_rows(results, claim, own, sides[1 - k] if len(sides) > 1 else None, extra)[0]
                 for k, own in enumerate(sides)]  # fmt: skip
        pairs = [set(zip(*(part[key] for key in keys), strict=True)) for part in parts]
        common = set.intersection(*pairs)
        count += len(common)
        bad = pd.concat([invalid_pairs(results, claim, part, keys) for part in parts])
        if len(parts) > 1 and claim.statistic == "difference":
            means = [part.groupby(keys, sort=False)["value"].mean() for part in parts]
            both = pd.concat(dict(zip(("first", "second"), means, strict=True)), axis=1, join="inner")
            same = both.index[_same_mesh(claim, both)]
            bad = pd.concat([bad, pd.Series(SAME, index=same, dtype=object)])
        bad = bad[~bad.index.duplicated()]
        found.append(bad[[pair in common for pair in (bad.index if len(keys) > 1 else zip(bad.index, strict=True))]])
    return pd.concat(found), count


def _same_mesh(claim: Claim, both: pd.DataFrame) -> pd.Series:
    """(pairs,) whether two simplifications have errors that are equal to the last digit, and not zero."""
    if claim.stage != "lod" or not claim.checked:
        return pd.Series(False, index=both.index)
    return (both["first"] == both["second"]) & (both["first"] > 0)


def _side_rows(
    results: Results, claim: Claim, own: Side, other: Side | float | None, extra: Side | None
) -> tuple[pd.DataFrame, list[str]]:
    """(rows of one side, columns over whose several values the side is a mean)."""
    where = {**claim.where, **(extra or {}), **own}
    dataset = where.pop("dataset", claim.sets[0])
    picks = {column: wanted for column, wanted in where.items() if isinstance(wanted, Pick)}
    patterns = {column: wanted for column, wanted in where.items() if isinstance(wanted, str) and "*" in wanted}
    plain = {column: wanted for column, wanted in where.items() if column not in picks | patterns}
    rows = results.measured(claim.stage, dataset, **plain)
    for column, wanted in patterns.items():
        rows = _some(rows[[fnmatch(str(name), wanted) for name in rows[column]]], claim, f"{column} like {wanted}")
    for column, wanted in picks.items():
        rows = rows[rows[column] == _picked(rows, claim, column, wanted, other)]
    keys = (*claim.over, *claim.within)
    return rows, [k for k, v in where.items() if k not in keys and (isinstance(v, tuple) or k in patterns)]


def _difference(results: Results, claim: Claim, extra: Side) -> pd.Series:
    if isinstance(claim.second, int | float):
        found = side(results, claim, claim.first, None, extra) - claim.second
    else:
        pooled = replace(claim, over=(), within=())  # all rows of a side, also those about no unit
        first, second = (
            side(results, pooled if claim.mean_of == name else claim, own, other, extra)
            for name, own, other in (("first", claim.first, claim.other), ("second", claim.other, claim.first))
        )
        if claim.mean_of:
            found = first.mean() - second if claim.mean_of == "first" else first - second.mean()
        else:
            joined = pd.concat({"first": first, "second": second}, axis=1, join="inner").dropna()
            joined = joined[~_same_mesh(claim, joined)]
            names = " and ".join(" ".join(map(either, one.values())) for one in (claim.first, claim.other))
            some(joined, f"no pairs of {names}", claim.stage, runnable=False)
            found = joined["first"] - joined["second"]
            if claim.relative:
                middle = (joined["first"] + joined["second"]) / 2
                found /= middle.where(middle > 0, 1.0)  # two errors of zero are equal
    return found.groupby(level=list(range(len(claim.over))), sort=False).mean() if claim.within else found


def _picked(rows: pd.DataFrame, claim: Claim, column: str, pick: Pick, other: Side | float | None) -> object:
    taken = other.get(column) if isinstance(other, dict) else None
    out = [*pick.but, *listed(taken or ())]
    rows = rows[[not any(fnmatch(str(name), str(one)) for one in out) for name in rows[column]]]
    rows = rows[rows[column].isin(pick.names)] if pick.names else rows
    _some(rows, claim, f"other {column} than {either(out)}" if out else column)
    table = rows.pivot_table(index=[*claim.over, *claim.within], columns=column, values="value", sort=False)
    found = (table if table.dropna().empty else table.dropna()).mean()  # over the pairs that all of them have
    return found.idxmin() if pick.lowest else found.idxmax()


def _some(rows: pd.DataFrame, claim: Claim, what: str) -> pd.DataFrame:
    return some(rows, f"no {what} is among those that {claim.stage} measured", claim.stage, runnable=False)
