"""Where the time went, by stage and method."""

from contextlib import suppress
from itertools import product

import pandas as pd

from stages.report.items import Table
from stages.report.results import NotRun, Results

KEYS = ["value", "metric", "note", "task", "view", "split"]  # in which rows of one piece of work differ
SEEN = "seen_share"  # rows of the views that stand for one piece of work, the views in a row


def build(results: Results) -> Table:
    """Seconds of all pieces of work of the sets that are switched on, the most first."""
    parts = []
    for stage, dataset in product(results.stages, results.sets):
        with suppress(NotRun):
            parts.append(_timed(results.rows(stage, dataset)).assign(stage=stage))
    timed = pd.concat(parts) if parts else pd.DataFrame()
    if timed.empty:
        raise NotRun("nothing was timed", "meshes")
    groups = timed.groupby(["stage", "method"], sort=False)["seconds"]
    frame = groups.agg(["size", "mean", "sum"]).reset_index()
    frame.columns = ["stage", "method", "pieces of work", "seconds each", "seconds"]
    frame["share, %"] = 100 * frame["seconds"] / (frame["seconds"].sum() or 1.0)
    frame = frame.sort_values("seconds", ascending=False, kind="stable")
    return Table(frame, words={"sets": ", ".join(results.sets)})


def _timed(rows: pd.DataFrame) -> pd.DataFrame:
    """Method and seconds of each piece of work of a stage on a set; empty where nothing was timed."""
    rows = rows.loc[~((rows["metric"] == SEEN) & (rows.get("views") != 1))].dropna(subset=["seconds"])
    rows = rows.drop(columns=[key for key in KEYS if key in rows]).drop_duplicates()
    return rows.assign(method=rows["method"].fillna("")).loc[:, ["method", "seconds"]]
