"""The claims on simplified meshes: their own statistics, and the table of all claims on every data set."""

from dataclasses import replace
from typing import Any

import pandas as pd

from stages.kit.stats import interval
from stages.report.claims import Claim
from stages.report.differences import invalid_pairs, statistic
from stages.report.items import Table
from stages.report.results import SECTION_3_2, NotRun, Results, listed, some
from stages.report.verdict import judge
from stages.report.words import dataset_text

from .claims import CLAIMS
from .methods import PLAIN, QSLIM, UNSEEN, fixed
from .rows import CELL, data_sets

WORDS = {"supported": "yes", "contradicted": "no", "no difference": "none"}  # the others as they are
MANY = 5  # methods that a rank correlation needs


def build(results: Results) -> Table:
    """One row per claim, one column per data set, and the first set again where nothing shrank."""
    sets, within = data_sets(results), [claim for claim in CLAIMS if "dataset" not in claim.first]
    within = [replace(claim, elsewhere=UNSEEN, dataset=(SECTION_3_2,)) for claim in within]  # that knows the object
    wanted = {dataset_text(name): (name, {}) for name in sets}
    wanted[f"{dataset_text(sets[0])}, nothing shrunk"] = sets[0], {"shrunk": False}
    parts = {
        head: judge([replace(one.on(name), where={**one.where, **where}) for one in within], results)
        for head, (name, where) in wanted.items()
    }
    frame = pd.concat([part.assign(data=head, objects=part["pairs"]) for head, part in parts.items()])
    texts = {head: [_cell(row) for row in part.itertuples()] for head, part in parts.items()}
    shown = frame.loc[frame["data"] == dataset_text(sets[0]), ["section", "claim"]].assign(**texts)
    frame = frame[["key", "data", "verdict", "effect", "low", "high", "objects"]].sort_values("key", kind="stable")
    return Table(frame, shown)  # no ranking: claims do not compete


def _cell(row: Any) -> str:
    return WORDS.get(str(row.verdict), str(row.verdict)) if row.pairs else "not run"


@statistic("spread")
def spread(results: Results, claim: Claim) -> pd.Series:
    """Standard deviation over the methods of the first side, under the first selection minus under the second."""
    tables = (_errors(results, claim, claim.first["method"], **where) for where in claim.contrast or ())
    one, other = (table.std(axis=1).droplevel("target") for table in tables)
    return one - other


@statistic("falls_with_faces")
def falls_with_faces(results: Results, claim: Claim) -> pd.Series:
    """Error at the fewest faces minus error at the largest number, of objects with several counts."""
    rows = results.measured(claim.stage, claim.sets[0], **claim.where, **claim.first).sort_values("faces")
    rows = _valid(results, claim, rows)
    rows = rows[rows.groupby("item")["faces"].transform("nunique") > 1]
    some(rows, "no object that is taken to two face counts", claim.stage, runnable=False)
    errors = rows.groupby("item")["value"]
    return errors.first() - errors.last()


@statistic("room")
def room(results: Results, claim: Claim) -> pd.Series:
    """Minus the relative difference from the second side of the method and metric whose interval leaves least room.

    With the claim's margin, an equivalence test by the interval: above zero where the whole interval of the difference
    lies within the margin (Schuirmann 1987, with the 95 % interval instead of 90 %: stricter).
    """
    base, gaps = claim.other["method"], []
    for metric in listed(claim.where["metric"]):
        table = _errors(results, claim, (base, *claim.first["method"]), metric=metric)
        if base not in table or table.shape[1] < 2:
            raise NotRun(f"lod did not run {base} beside another", claim.stage, runnable=False)
        middle = (table.add(table[base], axis=0) / 2).where(lambda both: both > 0, 1.0)
        shares = table.sub(table[base], axis=0) / middle
        gaps += [shares[name].groupby("item").mean() for name in table if name != base]
    return min((side * gap for gap in gaps for side in (-1, 1)), key=lambda found: interval(found)[1])


@statistic("ranks_agree")
def ranks_agree(results: Results, claim: Claim) -> pd.Series:
    """Rank correlation over the methods, per object, of the metrics of both sides; of the points without a second.

    Methods with a way behind their name keep the same points in another way and are left out.
    """
    metric = str(claim.first["metric"])
    errors = _by_method(results, claim, metric, "value")
    if errors.empty or errors.shape[1] < MANY:
        raise NotRun(f"fewer than {MANY} methods to rank", claim.stage, runnable=False)
    other = (str(claim.other["metric"]), "value") if claim.second else (metric, "points")
    return errors.corrwith(_by_method(results, claim, *other), axis=1, method="spearman")


def _errors(results: Results, claim: Claim, methods: tuple[str, ...], **where: object) -> pd.DataFrame:
    """Frame (object, target) x methods, where all of the methods that were run reach the target."""
    rows = results.measured(claim.stage, claim.sets[0], **{**claim.where, **where}, method=methods)
    table = _valid(results, claim, rows).pivot(index=CELL, columns="method", values="value").dropna()
    return some(table, f"no target that all of {', '.join(methods)} reach", claim.stage, runnable=False)


def _valid(results: Results, claim: Claim, rows: pd.DataFrame) -> pd.DataFrame:
    """The rows without those of an object and target at which a method's row is invalid."""
    bad = invalid_pairs(results, claim, rows, CELL).index
    return rows[~pd.MultiIndex.from_frame(rows[CELL]).isin(bad)] if len(bad) else rows


def _by_method(results: Results, claim: Claim, metric: str, column: str) -> pd.DataFrame:
    """Frame objects x methods of a column, mean over the targets that all methods reach; no objects without ranks."""
    rows = results.measured(claim.stage, claim.sets[0], **claim.where, metric=metric)
    rows = rows[[name not in (PLAIN, QSLIM) and fixed(name) for name in rows["method"]]]
    reached = rows.groupby(CELL)["method"].transform("nunique")
    rows = rows[reached == rows["method"].nunique()]
    table = rows.pivot_table(index="item", columns="method", values=column)
    return table[table.nunique(axis=1) > 1]
