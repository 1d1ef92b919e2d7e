"""What the pieces on T3.3 read: where networks look, beside people, rival models and controls."""

from collections.abc import Iterable, Sequence

import numpy as np
import pandas as pd

from stages.fixation import viewpoint_sphere
from stages.fixation.agreement import ALL_VIEWS
from stages.kit.files import read_arrays
from stages.report.results import NotRun, Results

from .detectors import KINDS, MODELS, Detector, untrained

VIEWPOINTS = viewpoint_sphere(1, 3)[:3]  # the three views whose maps are stored, whatever the settings
WHOLE = ("nss", "auc")  # of all views together; the other metrics are of each of three views
MARKED = "household"  # the data set whose marks come with the project
NO_PEOPLE = "The truth of the marked objects is no gaze: marks by a vision model, no human subjects took part."


def sources(results: Results, metric: str = "pcc") -> dict[str, pd.DataFrame]:
    """{whose attention the truth is: rows with a value}: of all sets that have rows of fixation, human gaze first.

    Those that have the metric; NotRun where none has. pcc: agreement with people, which needs people's attention.
    """
    found, missing = {}, []
    for dataset in sorted(results.datasets("fixation") or [None], key=lambda name: name != "gaze"):
        try:
            rows = results.rows("fixation", dataset).dropna(subset=["value"])
        except NotRun as absent:
            missing.append(str(absent))
            continue
        if (rows["metric"] == metric).any():
            found[_truth_text(rows, metric)] = rows
        else:
            missing.append("no object of this run has ground truth")
    if not found:
        raise NotRun("; ".join(missing), "fixation", runnable=False)
    return found


def _truth_text(rows: pd.DataFrame, metric: str) -> str:
    """`human gaze, 19 meshes`: what the objects of some rows are."""
    dataset, count = rows["dataset"].iloc[0], rows.loc[rows["metric"] == metric, "item"].nunique()
    if dataset == "gaze":
        return f"human gaze, {count} meshes"
    return f"{'marks' if dataset == MARKED and metric != 'pcc_tasks' else dataset}, {count} objects"


def no_people(found: Iterable[str]) -> str:
    """A sentence on the marks, where they are among the truths."""
    return f" {NO_PEOPLE}" if any(source.startswith("marks") for source in found) else ""


def scores(rows: pd.DataFrame, metric: str, by: Sequence[str] = ("item",)) -> pd.DataFrame:
    """Frame objects x (method, task) of a metric: the mean over the three views, or of all views for WHOLE.

    by: ("item", "view") for each of the three views. Distances are in per cent of the bounding sphere's diameter.
    """
    whole = rows["view"].astype(str) == ALL_VIEWS
    found = rows[(rows["metric"] == metric) & (whole == (metric in WHOLE))]
    table = found.pivot_table(index=list(by), columns=["method", "task"], values="value", sort=False)
    return 100 * table if metric.startswith("distance") else table


def detectors(table: pd.DataFrame) -> list[Detector]:
    """Those of a frame of scores that answer for a whole object: fused maps, rivals, controls; in this order."""
    found = (Detector(*name) for name in table.columns)
    whole = [name for name in found if name.task in MODELS or name.method in KINDS]
    return sorted(whole, key=lambda name: list(KINDS).index(name.kind))


def networks(rows: pd.DataFrame) -> list[str]:
    """The methods that are networks, those that learned from photographs first, in the order of the rows."""
    found = dict.fromkeys(rows.loc[rows["metric"].isin(["pcc", "pcc_tasks"]), "method"])
    return sorted((method for method in found if method not in KINDS), key=untrained)


def stored(results: Results, name: str, dataset: str | None = None) -> dict[str, np.ndarray]:
    """Arrays of data/SET/fixation/NAME.npz, as stages.fixation.read_attention describes them."""
    path = results.folder("fixation", dataset) / f"{name}.npz"
    if not path.exists():
        raise NotRun(f"no fixation/{name}.npz", "fixation")
    return read_arrays(path)


def stored_networks(arrays: dict[str, np.ndarray]) -> list[str]:
    """The networks whose attention a file holds, those that learned from photographs first."""
    return sorted((key.removesuffix(".maps") for key in arrays if key.endswith(".maps")), key=untrained)
