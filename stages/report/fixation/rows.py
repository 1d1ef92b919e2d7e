"""What the pieces on T3.3 read: where networks look, beside people, rival models and controls."""

from collections.abc import Iterable, Sequence

import numpy as np
import pandas as pd

from haptic_glance.base.files import read_arrays
from stages.fixation import viewpoint_sphere
from stages.fixation.agreement import ALL_VIEWS
from stages.report.results import GAZED, Results, some, there

from .detectors import FUSED, KINDS, NARROWED, Detector, untrained

VIEWPOINTS = viewpoint_sphere(1, 3)[:3]  # the three views whose maps are stored, whatever the settings
WHOLE = ("nss", "auc")  # of all views together; the other metrics are of each of three views
MARKED = "household"  # the data set whose marks come with the project
NO_PEOPLE = "The truth of the marked objects is no gaze: marks by a vision model, no human subjects took part."


def sources(results: Results, metric: str = "pcc") -> dict[str, pd.DataFrame]:
    """{whose attention the truth is: rows with a value}: of all sets that have the metric, human gaze first."""
    found, gazed = {}, dict(zip(GAZED, ("meshes", "point clouds"), strict=True))
    for dataset in sorted(results.datasets("fixation") or [None], key=lambda name: name not in gazed):
        rows = results.rows("fixation", dataset).dropna(subset=["value"])
        count = rows.loc[rows["metric"] == metric, "item"].nunique()
        name = "marks" if dataset == MARKED and metric != "pcc_tasks" else dataset
        if count:
            found[f"human gaze, {count} {gazed[dataset]}" if dataset in gazed else f"{name}, {count} objects"] = rows
    return some(found, "no object of this run has ground truth", "fixation", runnable=False)


def no_people(found: Iterable[str]) -> str:
    """A sentence on the marks, where they are among the truths."""
    return f" {NO_PEOPLE}" if any(source.startswith("marks") for source in found) else ""


def scores(rows: pd.DataFrame, metric: str, by: Sequence[str] = ("item",)) -> pd.DataFrame:
    """Frame `by` x (method, task) of a metric: means of three views (WHOLE: of all); distances, shares in per cent."""
    whole = rows["view"].astype(str) == ALL_VIEWS
    found = rows[(rows["metric"] == metric) & (whole == (metric in WHOLE))]
    table = found.pivot_table(index=list(by), columns=["method", "task"], values="value", sort=False)
    return 100 * table if metric.startswith("distance") or metric == "half_share" else table


def detectors(table: pd.DataFrame) -> list[Detector]:
    """Those of a frame of scores that answer for a whole object: fused maps, rivals, controls; in this order."""
    found = (Detector(*name) for name in table.columns)
    whole = [name for name in found if name.task in (FUSED, NARROWED) or name.method in KINDS]
    return sorted(whole, key=lambda name: list(KINDS).index(name.kind))


def networks(rows: pd.DataFrame) -> list[str]:
    """The methods that are networks, those that learned from photographs first, in the order of the rows."""
    found = dict.fromkeys(rows.loc[rows["metric"].isin(["pcc", "pcc_tasks"]), "method"])
    return sorted((method for method in found if method not in KINDS), key=untrained)


def stored(results: Results, name: str, dataset: str | None = None) -> dict[str, np.ndarray]:
    """Arrays of data/SET/fixation/NAME.npz, as stages.fixation.__main__ describes them."""
    path = results.folder("fixation", dataset) / f"{name}.npz"
    return read_arrays(there(path, f"no fixation/{name}.npz", "fixation"))
