"""T table 4.9: which class of objects is it, by following contours."""

from functools import partial

import numpy as np
import pandas as pd

from stages.kit.split import Split
from stages.report.grid import cell_text, percent
from stages.report.items import Table
from stages.report.results import Results
from stages.report.style import label
from stages.report.words import dataset_text

from .rows import BLIND, CLASSIFIERS, GUIDED, METRICS, SPLITS, STAGE, accuracy, whole

KEYS = ["objects", "split", "classifier"]


def build(results: Results) -> Table:
    """Accuracy by data set, split, classifier and strategy, beside the thesis's two columns."""
    thesis = results.thesis("table_4_9_sequences").set_index("classifier")
    printed = thesis.rename(columns={"blind": BLIND, "guided": GUIDED}).stack().to_dict()
    lines = []
    for source in results.datasets(STAGE) or [None]:
        rows = whole(results.measured(STAGE, source, metric=list(METRICS.values())))
        strategies = sorted(rows["method"].unique(), key=lambda method: (method != BLIND, method != GUIDED))
        lines += [
            _line(rows, source, split, classifier, method, printed)
            for split in SPLITS if split in set(rows["split"])
            for classifier in CLASSIFIERS for method in strategies
        ]  # fmt: skip
    frame = pd.DataFrame(lines)
    counts = frame.groupby("objects", sort=False)["sequences"].max()
    counted = ", ".join(f"{int(count):,} ({dataset_text(str(source))})" for source, count in counts.items())
    return Table(frame, _wide(frame), {"not_run": results.left_out(STAGE), "counted": counted})


def _line(
    rows: pd.DataFrame, source: str | None, split: Split, classifier: str, method: str, printed: dict
) -> dict[str, object]:
    mine = rows[(rows["method"] == method) & (rows["classifier"] == classifier)]
    mean, low, high, count = accuracy(mine, split)
    timed = mine[(mine["split"] == split) & (mine["metric"] == "accuracy")]
    return {
        "objects": source, "split": split, "classifier": classifier, "strategy": method, "accuracy": mean,
        "low": low, "high": high, "values": count,
        "thesis": printed.get((classifier, method), np.nan) if split == Split.RANDOM else np.nan,
        "chance": 1 / mine["classes"].max(), "sequences": mine["sequences"].max(), "seconds": timed["seconds"].median(),
    }  # fmt: skip


def _wide(frame: pd.DataFrame) -> pd.DataFrame:
    cells = frame.assign(text=[cell_text(row, places=1, gap=None) for _, row in frame.iterrows()])
    shown = cells.pivot_table(index=KEYS, columns="strategy", values="text", aggfunc="first", sort=False)
    shown = shown.rename(columns=lambda name: f"{label(name)}, %")
    shown["chance"] = frame.groupby(KEYS, sort=False)["chance"].first().map(partial(percent, places=1))
    shown = shown.reset_index()
    return shown.assign(
        objects=shown["objects"].map(dataset_text), split=shown["split"].map(SPLITS),
        classifier=shown["classifier"].map(CLASSIFIERS),
    )  # fmt: skip
