"""Paired differences of a claim on one data set: rows of its two sides, and the pairs in which the run says nothing."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

import pandas as pd

from stages.engine.measurements import Measurements, Missing, either, listed

from .claims import Claim, Pick, Side

NO_POINT, SAME, ALL_KEPT = "no point found", "both sides are the same mesh", "nothing was left out"
PLAIN = ("qem", "qslim")  # methods of the stage lod that keep no points; a name with -soft weighs the error instead


@dataclass
class Pairs:
    """The differences of a claim on one set, before scaling, indexed by its `over`.

    count: all pairs. silent: the cause of each pair in which the run says nothing. ringless: the share of the meshes
    that keep less than one ring of faces, NaN where nothing is kept.
    """

    differences: pd.Series
    count: int = 0
    silent: Counter[str] = field(default_factory=Counter)
    ringless: float = float("nan")


@dataclass(frozen=True)
class SideRows:
    """The values of one side by pair, the cause of each silent pair, and the rings of its meshes."""

    values: pd.Series
    silent: pd.Series
    rings: pd.Series


def difference(measurements: Measurements, claim: Claim, dataset: str) -> Pairs:
    """First side minus second, with all that the fields of a Claim say; Missing where no pair is left."""
    parts = [_difference(measurements, claim, dataset, where) for where in claim.contrast or ({},)]
    if not claim.contrast:
        return parts[0]
    differences = parts[0].differences - parts[1].differences
    return Pairs(differences, parts[0].count + parts[1].count, parts[0].silent + parts[1].silent, parts[0].ringless)


def _difference(measurements: Measurements, claim: Claim, dataset: str, extra: Side) -> Pairs:
    second = claim.second
    if second is None or isinstance(second, int | float):
        one = side_rows(measurements, claim, dataset, claim.first, extra=extra)
        values = one.values - (second or 0)
        return _found(claim, one.values.drop(one.silent.index, errors="ignore").index, values, [one], Counter())
    chosen = {"first": (claim.first, second), "second": (second, claim.first)}
    sides = {
        name: side_rows(measurements, claim, dataset, *pair, extra)
        for name, pair in chosen.items() if name != claim.mean_of
    }  # fmt: skip
    joined = pd.concat({name: side.values for name, side in sides.items()}, axis=1, join="inner")
    if claim.mean_of:
        joined[claim.mean_of] = selected(measurements, claim, dataset, *chosen[claim.mean_of], extra)[0]["value"].mean()
    same = pd.Series(False, index=joined.index)
    if claim.stage == "lod" and not claim.ties:  # errors that are equal to the last digit, and not zero
        same = (joined["first"] == joined["second"]) & (joined["first"] > 0)
    values = joined["first"] - joined["second"]
    if claim.relative:
        middle = (joined["first"] + joined["second"]) / 2
        values /= middle.where(middle > 0, 1.0)  # two errors of zero are equal
    names = " and ".join(" ".join(map(either, columns.values())) for columns in (claim.first, second))
    require_rows(values, f"no pairs of {names}")
    return _found(claim, same.index[~same], values, [*sides.values()], Counter({SAME: int(same.sum())}))


def _found(claim: Claim, told: pd.Index, values: pd.Series, sides: Sequence[SideRows], silent: Counter[str]) -> Pairs:
    """The Pairs of some values; told: the pairs that are no ties."""
    causes = pd.concat([side.silent for side in sides])
    causes = causes[causes.index.isin(values.index)]
    causes = causes[~causes.index.duplicated()]
    valid = values[values.index.isin(told) & ~values.index.isin(causes.index)]
    rings = pd.concat([side.rings for side in sides]).dropna()
    differences = valid if len(valid) else values
    if claim.within:
        differences = differences.groupby(level=list(range(len(claim.over))), sort=False).mean()
    silent = +(silent + Counter(causes))
    return Pairs(differences, len(values), silent, float((rings < 1).mean()) if len(rings) else float("nan"))


def side_rows(
    measurements: Measurements, claim: Claim, dataset: str, selection: Side, other: Side | float | None = None,
    extra: Side | None = None,
) -> SideRows:  # fmt: skip
    """The values of one side, indexed by over and within; of several named values the mean where all were measured.

    other: the other side, whose values a Pick leaves out. extra: further columns that both sides have in common.
    """
    rows, where = selected(measurements, claim, dataset, selection, other, extra)
    keys = [*claim.over, *claim.within]
    if not keys:
        value = pd.Series([rows["value"].mean()], name="value")
        return SideRows(value, pd.Series(dtype=object), pd.Series(dtype=float))
    for column in keys:
        if column not in rows:
            raise Missing(f"no column {column} in the rows of {claim.stage}", claim.stage)
    several = [column for column, value in where.items() if column not in keys and isinstance(value, tuple)]
    if several:
        cells = rows.groupby([*keys, *several], sort=False)["value"].mean()
        values = cells.unstack(several, sort=False).dropna().mean(axis=1)
    else:
        values = rows.groupby(keys, sort=False)["value"].mean()
    causes = silent_rows(measurements, claim, rows)
    bad = causes[causes != ""]
    silent = bad.groupby([rows[key] for key in keys], sort=False).first() if len(bad) else bad
    rings = rows.loc[_keeps(rows), "rings"] if claim.stage == "lod" and "rings" in rows else pd.Series(dtype=float)
    return SideRows(values, silent, rings.astype(float))


def selected(
    measurements: Measurements, claim: Claim, dataset: str, selection: Side, other: Side | float | None = None,
    extra: Side | None = None,
) -> tuple[pd.DataFrame, dict[str, object]]:  # fmt: skip
    """(the measured rows of a side, with its picks made; the columns and values that select them)."""
    where = {**claim.where, **(extra or {}), **selection}
    where.pop("column", None)
    stage, name = str(where.pop("stage", claim.stage)), str(where.pop("dataset", dataset))
    plain = {column: value for column, value in where.items() if not isinstance(value, Pick)}
    rows = measurements.measured(stage, name, **plain)
    for column, pick in where.items():
        if isinstance(pick, Pick):
            parts = [rows]
            if claim.contrast:  # one method in both parts, by what the contrast is of
                parts = [measurements.measured(stage, name, **{**plain, **part}) for part in claim.contrast]
            rows = rows[rows[column] == _picked(parts, claim, column, pick, other)]
    return rows, where


def silent_rows(measurements: Measurements, claim: Claim, rows: pd.DataFrame) -> pd.Series:
    """(n,) the cause why a row says nothing, else empty text: its method found no point, or left no touch out."""
    causes = pd.Series("", index=rows.index, dtype=object)
    if claim.stage == "lod" and "points" in rows:
        causes[_keeps(rows) & (rows["points"] == 0)] = NO_POINT
    if claim.stage == "recorded" and {"train", "test"} <= set(rows) and rows["method"].str.startswith("selected").any():
        size = rows["train"] + rows["test"]
        whole = measurements.rows(claim.stage, str(rows["dataset"].iloc[0]), method="all")
        counts = (whole["train"] + whole["test"]).groupby(whole["group"]).max()
        causes[rows["method"].str.startswith("selected") & (size == rows["group"].map(counts))] = ALL_KEPT
    return causes


def _keeps(rows: pd.DataFrame) -> pd.Series:
    """(n,) whether a method of the stage lod keeps neighbourhoods."""
    return ~rows["method"].isin(PLAIN) & ~rows["method"].str.endswith("-soft")


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
