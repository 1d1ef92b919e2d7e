"""The errors of simplified meshes, compared on the same objects and targets only."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.grid import grouped, over_items, within
from stages.report.markdown import with_interval
from stages.report.results import ON_GREY, ON_WHITE, Results, some

from .methods import PLAIN, UNSEEN

CELL = ["item", "target"]
ERRORS = {  # metric -> name, with its unit
    "metro_mean": "Metro mean, %", "metro_rms": "Metro rms, %", "metro_max": "Metro max, %",
    "ssim_error": "1 − SSIM, %", "dlap": "DLap", "dnor": "Dnor",
    "salient_error": "error where our model looks, %", "gaze_error": "error where people look, %",
}  # fmt: skip
UNITS = {metric: 100 if name.endswith("%") else 1 for metric, name in ERRORS.items()}  # factors to the unit
METRICS = ("metro_mean", "ssim_error")  # those of the thesis's figures
FEWEST = 3  # objects that a mean over objects needs to be shown


def data_sets(results: Results, methods: Iterable[str] = ()) -> list[str]:
    """The sets with meshes simplified by any of these methods (none: by any), those that are switched on first.

    Without those of one method on other backgrounds.
    """
    names, wanted = results.datasets("lod"), set(methods)
    found = [
        name for name in names
        if name not in (ON_GREY, ON_WHITE)
        and (not wanted or wanted & set(results.rows("lod", name)["method"].replace(UNSEEN)))
    ]  # fmt: skip
    return some(found, "no measurements of lod", "lod")


def paired_cells(
    results: Results, metrics: Iterable[str] = ERRORS, methods: Iterable[str] | None = None,
    dataset: str | None = None, whole: bool = False,
) -> pd.DataFrame:  # fmt: skip
    """Rows of these errors and methods (None: of all), only where all methods that were run reach the object's target.

    `seconds` is the simplification's; `plain` the value of plain QEM for the same object, target and metric. whole:
    only where, moreover, no method had to shrink its neighbourhoods: the thesis's own algorithm. Methods that have
    learned from the object itself, as printed, have the names of those that have not.
    """
    rows = results.rows("lod", dataset, metric=[*metrics, "faces"]).dropna(subset=["value"])
    rows["method"] = rows["method"].replace(UNSEEN)
    made = rows.loc[rows["metric"] == "faces", [*CELL, "method", "seconds"]]
    rows = rows[rows["metric"] != "faces"].drop(columns="seconds")
    plain = rows[rows["method"] == PLAIN].rename(columns={"value": "plain"})[[*CELL, "metric", "plain"]]
    rows = rows if methods is None else rows[rows["method"].isin(list(methods))]
    rows = rows.merge(made, on=[*CELL, "method"]).merge(plain, on=[*CELL, "metric"], how="left")
    counted = rows["method"].mask(rows["shrunk"].fillna(False).astype(bool)) if whole else rows["method"]
    reached = rows.assign(method=counted).groupby([*CELL, "metric"])["method"].transform("nunique")
    return rows[reached == rows["method"].nunique()]


def compared(rows: pd.DataFrame, by: list[str], least: float = 0.0) -> pd.DataFrame:
    """Mean, its interval from `least` on, and mean difference from `plain`, over the objects of each value of `by`."""
    found = []
    for key, group in grouped(rows, by):
        gain = interval(over_items(group.assign(value=group["value"] - group["plain"])))
        found.append((*key, *within(over_items(group), least=least, top=np.inf), group["value"].count(), *gain))
    ends = ["mean", "low", "high", "objects", "over_plain", "over_plain_low", "over_plain_high"]
    return pd.DataFrame(found, columns=[*by, *ends])


def by_object(rows: pd.DataFrame, methods: list[str], metric: str, target: str | None = None) -> pd.DataFrame:
    """Frame objects x methods of one error in its unit; target: at this one alone, or the mean over all."""
    rows = rows[(rows["metric"] == metric) & (rows["target"].eq(target) if target else True)]
    return UNITS[metric] * rows.pivot_table(index="item", columns="method", values="value").reindex(columns=methods)


def face_counts(rows: pd.DataFrame) -> list[str]:
    """The targets of the rows with enough objects, most faces first: counts, or shares where there are no counts."""
    objects = rows.groupby("target")["item"].nunique()
    enough = sorted(objects.index[objects >= FEWEST], key=size)
    return [target for target in enough if target.isdigit()] or enough


def wide(cells: pd.DataFrame, down: str | list[str], across: str) -> pd.DataFrame:
    """Column `text` pivoted, rows and columns in the order of the cells; `–` where there is none."""
    found = cells.pivot(index=down, columns=across, values="text").rename_axis(columns=None)
    return found.reindex(cells.set_index(down).index.unique(), columns=cells[across].unique()).fillna("–")


def cell(row: Any) -> str:
    """`1.2 [1.1, 1.3] +`: an error with its interval, + or – where it differs from plain QEM beyond chance."""
    mark = " +" if row.over_plain_low > 0 else " –" if row.over_plain_high < 0 else ""
    return with_interval(row.mean, row.low, row.high, UNITS[row.metric]) + mark


def size(target: str) -> tuple[bool, float]:
    """A key that sorts targets: shares before counts, large before small."""
    return (not target.endswith("%"), -float(target.rstrip("%")))


def said(target: str) -> str:
    """A target in words: `25%`, `1,500 faces`."""
    return target if target.endswith("%") else f"{int(target):,} faces"
