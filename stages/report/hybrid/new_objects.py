"""T6.3: how well a new head alone learns new objects on the device, in sentences below the table of T5.5."""

import pandas as pd

from stages.report.results import NotRun, Results
from stages.report.tables import grouped, number, with_interval, within
from stages.report.words import dataset_text

METRIC = "new_object_accuracy"
METHODS = {
    "hybrid_head": "a new head on the hybrid's features", "imagenet_head": "a new head on ImageNet's features",
    "hybrid_nearest": "the nearest touch by the hybrid's features",
    "imagenet_nearest": "the nearest touch by ImageNet's features",
}  # fmt: skip


def sentences(results: Results) -> str:
    """A line for each data set and method: accuracy by touches, and seconds on one core."""
    lines = []
    for dataset in results.datasets("transfer"):
        try:
            rows = results.measured("transfer", dataset, metric=METRIC)
        except NotRun:
            continue
        lines += [
            f"{dataset_text(dataset)}, {METHODS[name]}: {_counts(own)}."
            for (name,), own in grouped(rows[rows["method"] != "chance"], ["method"])
        ]
        guessing = rows.loc[rows["method"] == "chance", "value"].iloc[0]
        lines[-1] += f" {rows['item'].nunique()} new objects, guessing {100 * guessing:.1f} %."
    return "\n".join(lines)


def _counts(rows: pd.DataFrame) -> str:
    """`31 [25, 37] % after 1 touch, ... (0.1 to 0.9 s)` of one method, with the interval over the objects."""
    said = [
        f"{with_interval(*within(own['value']), 100, 0)} % after {count:g} touch{'es' if count > 1 else ''}"
        for (count,), own in grouped(rows, ["severity"])
    ]
    seconds = rows.groupby("severity")["seconds"].median()
    return f"{', '.join(said)}, in {number(seconds.min(), 2)} to {number(seconds.max(), 2)} s an object on one core"
