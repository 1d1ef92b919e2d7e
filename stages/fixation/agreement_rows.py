"""Detectors of T3.3 and their rows of scores: fused maps of networks, rival models and controls, beside people.

`Detector` and the constants name the detectors and their words for readers. `sources` selects the data sets by truth,
human gaze before marks. `scores` makes one frame of a metric, objects by method and task, for the tables, figures and
claims.
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd

from haptic_glance.base.files import read_arrays
from stages.charts.datasets import GAZED
from stages.charts.drawing import CYCLE, GREY, label
from stages.charts.results import Results, require_file, require_rows
from stages.fixation.agreement import ALL_VIEWS
from stages.fixation.tasks import LEVELS, SHAPE_MEASURES, viewpoint_sphere

FUSED, NARROWED = "ewigc", "ewigc_l4"  # T eq. 3.24 and 3.25
NAMES = {FUSED: "EWIGC", NARROWED: "EWIGC_L4", "random": "noise"}
TASKS = (*LEVELS, *SHAPE_MEASURES)  # in the order of T figure 3.30
# Words, and colour.
KINDS = {"fused": ("Grad-CAM of a network", CYCLE[0]), "rival": ("other model", GREY), "control": ("control", CYCLE[1])}


class Detector(NamedTuple):
    """A column of a frame of scores."""

    method: str  # "rival", "control", or a network with what of it learned
    task: str  # or model

    @property
    def kind(self) -> str:
        """A key of KINDS."""
        return self.method if self.method in KINDS else "control" if untrained(self.method) else "fused"

    @property
    def text(self) -> str:
        """As a person says it."""
        name = task_text(self.task)
        return name if self.method in KINDS else f"{name}, {network_text(self.method)}"


LEE, OURS = Detector("rival", "mesh_saliency"), Detector("rival", "glance")
RIVALS = {"Leifman's regions of interest": "leifman", "Song's spectral saliency": "song", "Tasse's clusters": "tasse"}
PRIOR, NOISE = Detector("control", "centre_prior"), Detector("control", "random")


def untrained(method: str) -> bool:
    """True for a network that learned nothing but its heads."""
    return method.endswith("-random")


def with_random_weights(method: str) -> str:
    """The same network with random weights."""
    return f"{method.rpartition('-')[0]}-random"


def network_text(method: str) -> str:
    """`VGG16, frozen`: the network of a method and what of it learned."""
    network, _, mode = method.rpartition("-")
    return f"{label(network)}, {'random weights' if mode == 'random' else label(mode)}"


def task_text(task: str) -> str:
    """A task or model as a person says it."""
    return NAMES.get(task, label(task))


VIEWPOINTS = viewpoint_sphere(1, 3)[:3]  # the three views whose maps are stored, whatever the settings
WHOLE = ("nss", "auc")  # of all views together; the other metrics are of each of three views
MARKED = "household"  # the data set whose marks come with the project
NO_PEOPLE = "The truth of the marked objects is no gaze: marks by a vision model, no human subjects took part."


def sources(results: Results, metric: str = "pcc") -> dict[str, pd.DataFrame]:
    """{whose attention the truth is: rows with a value}: of all sets that have the metric, human gaze first."""
    truths, gazed = {}, dict(zip(GAZED, ("meshes", "point clouds"), strict=True))
    for dataset in sorted(results.datasets("fixation") or [None], key=lambda name: name not in gazed):
        rows = results.rows("fixation", dataset).dropna(subset=["value"])
        count = rows.loc[rows["metric"] == metric, "item"].nunique()
        name = "marks" if dataset == MARKED and metric != "pcc_tasks" else dataset
        if count:
            truths[f"human gaze, {count} {gazed[dataset]}" if dataset in gazed else f"{name}, {count} objects"] = rows
    return require_rows(truths, "no object of this run has ground truth", "fixation", runnable=False)


def no_people(truths: Iterable[str]) -> str:
    """A sentence on the marks, where they are among the truths."""
    return f" {NO_PEOPLE}" if any(source.startswith("marks") for source in truths) else ""


def scores(rows: pd.DataFrame, metric: str, by: Sequence[str] = ("item",)) -> pd.DataFrame:
    """Frame `by` x (method, task) of a metric: means of three views (WHOLE: of all); distances, shares in per cent."""
    whole = rows["view"].astype(str) == ALL_VIEWS
    metric_rows = rows[(rows["metric"] == metric) & (whole == (metric in WHOLE))]
    table = metric_rows.pivot_table(index=list(by), columns=["method", "task"], values="value", sort=False)
    return 100 * table if metric.startswith("distance") or metric == "half_share" else table


def detectors(table: pd.DataFrame) -> list[Detector]:
    """The detectors, in a frame of scores, of a whole object: fused maps, rivals, controls; in this order."""
    columns = (Detector(*name) for name in table.columns)
    whole = [name for name in columns if name.task in (FUSED, NARROWED) or name.method in KINDS]
    return sorted(whole, key=lambda name: list(KINDS).index(name.kind))


def networks(rows: pd.DataFrame) -> list[str]:
    """The methods that are networks, those that learned from photographs first, in the order of the rows."""
    methods = dict.fromkeys(rows.loc[rows["metric"].isin(["pcc", "pcc_tasks"]), "method"])
    return sorted((method for method in methods if method not in KINDS), key=untrained)


def stored(results: Results, name: str, dataset: str | None = None) -> dict[str, np.ndarray]:
    """Arrays of data/SET/fixation/NAME.npz, as stages.fixation.__main__ describes them."""
    path = results.folder("fixation", dataset) / f"{name}.npz"
    return read_arrays(require_file(path, f"no fixation/{name}.npz", "fixation"))
