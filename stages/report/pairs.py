"""Paired differences of a claim: rows of its two sides, the pairs that both have, and the pairs that are invalid."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import pandas as pd

from stages.engine.measurements import Measurements, Missing, either, listed

from .claims import Claim, Pick, Side
from .validity import CHECKS, SAME, causes

TOO_MANY = 0.2  # share of invalid pairs from which a claim cannot be tested


def difference(results: Measurements, claim: Claim) -> pd.Series:
    """First side minus second, with all that the fields of a Claim say."""
    parts = [_difference(results, claim, where) for where in claim.contrast or ({},)]
    return parts[0] - parts[1] if claim.contrast else parts[0]


def side(
    results: Measurements, claim: Claim, selection: Side, other: Side | float | None, extra: Side | None = None
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


def reasons_of(results: Measurements, claim: Claim, rows: pd.DataFrame) -> pd.Series:
    """The cause why a row is invalid, empty text for a valid row; no rows where a claim is not checked."""
    if not claim.checked or claim.stage not in CHECKS:
        return pd.Series(dtype=object)
    return causes(results, claim.stage, str(rows["dataset"].iloc[0]), rows)


def invalid(results: Measurements, claim: Claim) -> tuple[pd.Series, int]:
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
    results: Measurements, claim: Claim, selection: Side, other: Side | float | None, extra: Side | None
) -> SideRows:
    """The SideRows of a selection, which the check of a claim and its difference both ask for."""
    where = {**claim.where, **(extra or {}), **selection}
    dataset = str(where.pop("dataset", claim.sets[0]))
    keys = (*claim.over, *claim.within)
    query = (claim.stage, dataset, keys, claim.checked, repr(where), repr(other))
    return results.cached_recently(query, lambda: _select(results, claim, where, dataset, other))


def _select(
    results: Measurements, claim: Claim, where: dict[str, object], dataset: str, other: Side | float | None
) -> SideRows:
    picks = {column: value for column, value in where.items() if isinstance(value, Pick)}
    plain = {column: value for column, value in where.items() if column not in picks}
    rows = results.measured(claim.stage, dataset, **plain)
    for column, value in picks.items():
        parts = [rows]
        if claim.contrast:  # one method in both parts, by what the contrast is of
            parts = [results.measured(claim.stage, dataset, **{**plain, **part}) for part in claim.contrast]
        valid = [_mostly_valid(part, column, reasons_of(results, claim, part)) for part in parts]
        try:
            choice = _picked(valid, claim, column, value, other)
        except Missing:
            choice = _picked(parts, claim, column, value, other)
        rows = rows[rows[column] == choice]
    keys = [*claim.over, *claim.within]
    for column in keys:
        if column not in rows:
            raise Missing(f"no column {column} in the rows of {claim.stage}", claim.stage)
    several = [k for k, v in where.items() if k not in keys and isinstance(v, tuple)]
    return SideRows(rows, keys, several, reasons_of(results, claim, rows))


def _difference(results: Measurements, claim: Claim, extra: Side) -> pd.Series:
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
            require_rows(side_values, f"no pairs of {names}")
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
        rows = rows[rows[column].notna() & ~rows[column].isin(out)]
        rows = rows[rows[column].isin(pick.names)] if pick.names else rows
        require_rows(rows, f"{claim.stage} measured no other {column} than {either(out)}")
        cells = rows.groupby([*claim.over, *claim.within, column], sort=False)["value"].mean()
        tables.append(cells.unstack(column, sort=False))
    table = tables[0] if len(tables) == 1 else (tables[0] - tables[1]).dropna(axis=1, how="all")
    require_rows(table, f"{claim.stage} measured no {column} in both parts")
    averages = (table if table.dropna().empty else table.dropna()).mean()  # over the pairs that all of them have
    return averages.idxmin() if pick.lowest else averages.idxmax()


def require_rows(found: pd.Series | pd.DataFrame, message: str) -> None:
    """Raises Missing of `message` where nothing was found."""
    if found.empty:
        raise Missing(message)
