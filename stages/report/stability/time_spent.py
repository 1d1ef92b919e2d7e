"""Where the time went, by stage and method."""

from contextlib import suppress
from itertools import product

import pandas as pd

from stages.report.items import Table
from stages.report.results import NotRun, Results, some
from stages.report.style import label

KEYS = ["value", "metric", "note", "task", "view", "split"]  # in which rows of one piece of work differ
SEEN = "seen_share"  # rows of the views that stand for one piece of work, the views in a row


def build(results: Results) -> Table:
    """Seconds of all pieces of work of the sets that are switched on, the most first."""
    parts = []
    for stage, dataset in product(results.stages, results.sets):
        with suppress(NotRun):
            rows = results.rows(stage, dataset).dropna(subset=["seconds"])
            rows = rows.loc[~((rows["metric"] == SEEN) & (rows.get("views") != 1))]
            parts.append(rows.drop(columns=KEYS, errors="ignore").drop_duplicates().assign(stage=stage))
    timed = pd.concat(some([part for part in parts if len(part)], "nothing was timed", "meshes"))
    said = {"pieces of work": "size", "seconds each": "mean", "seconds": "sum"}
    frame = timed.fillna({"method": ""}).groupby(["stage", "method"], sort=False)["seconds"].agg(**said).reset_index()
    frame["share, %"] = 100 * frame["seconds"] / frame["seconds"].sum()
    frame = frame.sort_values("seconds", ascending=False, kind="stable")
    said = {name: frame[name].map(label) for name in ("stage", "method")}
    return Table(frame, frame.assign(**said), words={"sets": ", ".join(results.sets)})
