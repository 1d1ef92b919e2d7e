"""Table of classifiers on grasps by three BioTac SP fingertips: slip or hold, and one of 51 objects."""

import pandas as pd

from haptic_glance.know.split import Split, shared_by
from stages.engine.statistics import interval
from stages.report.drawing import label
from stages.report.items import Table
from stages.report.results import Results
from stages.report.tables import (
    Ranking,
    grid,
    grouped,
    records,
)

BY = ["task", "split", "palm", "scaled", "components"]
TASKS = {
    ("slip", Split.TEST_OBJECTS): "slips or not, ten objects kept for the test",
    ("slip", Split.OBJECTS): "slips or not, objects left out of training in turn",
    ("recognition", Split.RANDOM): "which of 51 objects, a random quarter held out",
    ("recognition", Split.BLOCKS): "which of 51 objects, a run of rows held out",
}
PALMS = ("all", "45", "down", "side")
SCALED = {"training": "training part", "own": "each part by its own"}


def grasps_table(results: Results) -> Table:
    """Accuracy by task, palm direction, scaling, values and classifier, and how far the electrodes drift."""
    rows = results.rows("recorded", "biotac_grasps")
    lines = []
    for key, group in grouped(rows[rows["metric"] == "accuracy"], [*BY, "classifier"]):
        shared = shared_by(Split.RANDOM) if group["item"].isna().all() else 0.0
        lines.append((*key, *interval(group["value"], shared)))
    frame = pd.DataFrame(lines, columns=[*BY, "classifier", "accuracy", "low", "high"]).astype({"components": int})
    drift = {
        metric: ", ".join(f"palm {row.palm} {row.value:.1f}" for row in records(rows[rows["metric"] == metric]))
        for metric in ("drift", "drift_drawn")
    }
    tasks = [TASKS[pair] for pair in zip(frame["task"], frame["split"], strict=True)]
    cells = frame.assign(
        task=pd.Categorical(tasks, list(TASKS.values())), palm=pd.Categorical(frame["palm"], PALMS),
        low=frame["low"].clip(lower=0), high=frame["high"].clip(upper=1),
    )  # fmt: skip
    keys = ["task", "palm", "scaled", "components"]
    names = {"scaled": SCALED.get, "components": lambda count: "12 components" if count == 12 else "electrodes"}
    cells = cells.sort_values(keys)
    wide = grid(cells, keys, "classifier", names=names, head=lambda name: f"{label(name)}, %")
    wide = wide.rename(columns={"scaled": "scaled by", "components": "values"})
    return Table(frame, wide, drift | {"better": _better(frame)}, Ranking("kNN, %", among=["task"]))


def _better(frame: pd.DataFrame) -> str:
    """How many classifiers are better than the majority on one palm direction, by the way they are scaled."""
    test = (frame["task"] == "slip") & (frame["split"] == Split.TEST_OBJECTS) & (frame["palm"] != "all")
    trials = frame[test].set_index(BY)
    common = trials.loc[trials["classifier"] == "majority", "accuracy"]
    learners = trials[trials["classifier"] != "majority"]
    counts = (learners["low"] > common.reindex(learners.index)).groupby(["palm", "scaled"]).agg(["sum", "size"])
    texts = [f"palm {palm}, {SCALED[way]} {better} of {count}" for palm, way, better, count in counts.to_records()]
    return "; ".join(texts)
