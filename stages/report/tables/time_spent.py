"""Where the time went, by stage and method."""

import pandas as pd

from stages.report.items import Table
from stages.report.results import NotRun

NOTES = [
    "Seconds of work summed over objects, as each stage measured them in the run that made its figures: several "
    "workers share them, so wall time is shorter. What a stage does not time (start, files) is not in here.",
    "A row of measurements that repeats the seconds of one piece of work under several metrics, tasks or views counts "
    "once.",
]
KEYS = ["value", "metric", "note", "task", "view", "split"]  # in which rows of one piece of work differ
SEEN = "seen_share"  # rows of the views that stand for one piece of work, the views in a row


def build(results):
    lines = []
    for stage in results.measured_stages:
        rows = results.measurements(stage)
        if "seconds" not in rows:
            continue
        rows = rows[~((rows["metric"] == SEEN) & (rows.get("views") != 1))]
        rows = rows.dropna(subset=["seconds"]).drop(columns=[key for key in KEYS if key in rows]).drop_duplicates()
        rows = rows.assign(method=rows["method"].fillna("") if "method" in rows else "")
        for method, group in rows.groupby("method"):
            lines.append(
                {
                    "stage": stage,
                    "method": method,
                    "pieces of work": len(group),
                    "seconds each": group["seconds"].mean(),
                    "seconds": group["seconds"].sum(),
                }
            )
    if not lines:
        raise NotRun("nothing was timed", "meshes")
    frame = pd.DataFrame(lines)
    total = frame["seconds"].sum()
    frame["share, %"] = 100 * frame["seconds"] / total if total else 0.0
    frame = frame.sort_values("seconds", ascending=False, kind="stable")
    return Table("Where the time went", frame, NOTES)
