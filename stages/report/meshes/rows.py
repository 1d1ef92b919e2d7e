"""The errors of simplified meshes, compared on the same objects and targets only."""

from collections.abc import Iterable, Sequence
from typing import Any

import pandas as pd

from stages.report.markdown import with_interval
from stages.report.results import Results

STAGE = "lod"
CELL = ["item", "target"]
PLAIN, OURS = "qem", "enhanced"
ERRORS = {  # metric -> (name, factor to the unit in which it is shown)
    "metro_mean": ("Metro mean, %", 100), "metro_rms": ("Metro rms, %", 100), "metro_max": ("Metro max, %", 100),
    "ssim_error": ("1 − SSIM, %", 100), "dlap": ("DLap", 1), "dnor": ("Dnor", 1),
    "salient_error": ("error where our model looks, %", 100), "gaze_error": ("error where people look, %", 100),
}  # fmt: skip
FEWEST = 3  # objects that a mean over objects needs to be shown


def data_sets(results: Results) -> list[str]:
    """The sets with simplified meshes, those that are switched on first; NotRun where there is none."""
    results.rows(STAGE)
    return results.datasets(STAGE)


def cells(
    results: Results, metrics: Sequence[str], dataset: str | None = None, methods: Iterable[str] | None = None
) -> pd.DataFrame:
    """Measured rows of the lod stage with these metrics; methods: of these alone (None: of all).

    `seconds` is the simplification's; `plain` the value of plain QEM for the same object, target and metric.
    """
    rows = results.rows(STAGE, dataset, metric=[*metrics, "faces"]).dropna(subset=["value"]).astype({"target": str})
    rows = rows if methods is None else rows[rows["method"].isin([PLAIN, *methods])]
    made = rows.loc[rows["metric"] == "faces", [*CELL, "method", "seconds"]]
    rows = rows[rows["metric"].isin(metrics)].drop(columns="seconds")
    plain = rows.loc[rows["method"] == PLAIN, [*CELL, "metric", "value"]].rename(columns={"value": "plain"})
    rows = rows if methods is None else rows[rows["method"].isin(methods)]
    return rows.merge(made, on=[*CELL, "method"]).merge(plain, on=[*CELL, "metric"], how="left")


def paired_cells(
    results: Results,
    metrics: Sequence[str],
    methods: Iterable[str],
    dataset: str | None = None,
    whole: bool = False,
) -> pd.DataFrame:
    """As `cells`, of those of the methods that were run, only where all of them reach the target of the object.

    whole: only where, moreover, none of them had to shrink its neighbourhoods: the thesis's own algorithm.
    """
    rows = cells(results, metrics, dataset, methods)
    counted = rows[~rows["shrunk"].fillna(False).astype(bool)] if whole else rows
    key = [*CELL, "metric"]
    reached = counted.groupby(key)["method"].nunique()
    everywhere = reached.index[reached == rows["method"].nunique()]
    return rows[pd.MultiIndex.from_frame(rows[key]).isin(everywhere)]


def face_counts(rows: pd.DataFrame) -> list[str]:
    """The targets of the rows with enough objects, most faces first: counts, or shares where there are no counts."""
    objects = rows.groupby("target")["item"].nunique()
    enough = sorted(objects.index[objects >= FEWEST], key=size)
    return [target for target in enough if target.isdigit()] or enough


def marked(row: Any, factor: float) -> str:
    """`1.2 [1.1, 1.3] +`: a mean with its interval, + or – where it differs from plain QEM beyond chance."""
    mark = " +" if row.over_plain_low > 0 else " –" if row.over_plain_high < 0 else ""
    return with_interval(row.mean, row.low, row.high, factor) + mark


def size(target: str) -> tuple[bool, float]:
    """A key that sorts targets: shares before counts, large before small."""
    return (not target.endswith("%"), -float(target.rstrip("%")))


def said(target: str) -> str:
    """A target in words: `25%`, `1,500 faces`."""
    return target if target.endswith("%") else f"{int(target):,} faces"
