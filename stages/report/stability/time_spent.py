"""Where the time went, by stage and method."""

import pandas as pd

from stages.report.items import Table
from stages.report.results import NotRun, Results

NOTES = [
    "Seconds of work summed over objects, as each stage measured them in the run that made its figures: several "
    "workers share them, so wall time is shorter. What a stage does not time (start, files) is not in here.",
    "A row of measurements that repeats the seconds of one piece of work under several metrics, tasks or views counts "
    "once.",
]
KEYS = ["value", "metric", "note", "task", "view", "split"]  # in which rows of one piece of work differ
SEEN = "seen_share"  # rows of the views that stand for one piece of work, the views in a row


def build(results: Results) -> Table:
    parts = [_timed(results, stage, dataset) for stage in results.stages for dataset in results.sets]
    parts = [part for part in parts if len(part)]
    if not parts:
        raise NotRun("nothing was timed", "meshes")
    groups = pd.concat(parts).groupby(["stage", "method"], sort=False)["seconds"]
    frame = groups.agg(["size", "mean", "sum"]).reset_index()
    frame.columns = ["stage", "method", "pieces of work", "seconds each", "seconds"]
    total = frame["seconds"].sum()
    frame["share, %"] = 100 * frame["seconds"] / total if total else 0.0
    frame = frame.sort_values("seconds", ascending=False, kind="stable")
    return Table("Where the time went", frame, [*NOTES, f"Data sets: {', '.join(results.sets)}."])


def _timed(results, stage, dataset):
    """Stage, method and seconds of each piece of work of a stage on a set; empty where nothing was timed."""
    try:
        rows = results.rows(stage, dataset)
    except NotRun:
        return pd.DataFrame()
    rows = rows[~((rows["metric"] == SEEN) & (rows.get("views") != 1))].dropna(subset=["seconds"])
    rows = rows.drop(columns=[key for key in KEYS if key in rows]).drop_duplicates()
    return rows.assign(stage=stage, method=rows["method"].fillna(""))[["stage", "method", "seconds"]]
