"""Looks once at each known object, touches it where the candidates differ, and says when it is known (T5.6, T6.3).

Reads data/SET/meshes and data/SET/salient_points. Each object stands at drawn azimuths. One picture is taken, half
hidden or not, and the hand touches along lines: planned, spread, at random, or at places of attention. The belief over
objects and azimuths follows from the picture and from the travel and the imprint of each touch. Objects of
one shape count once. The class of an object is that of classes.csv, or what precedes the number in its name.

Writes data/SET/look_and_touch/names.json (the objects and their classes) and
reports/measurements/SET/look_and_touch.csv.gz. Metrics of an object: `right` after each number of touches;
`touches_to_sure`; the shares `sure` and `sure_right`; and `class_right` if the object itself is not known. Of all
objects: `reliable`, the share of right answers in each fifth of the stated probabilities.
"""

import functools
import re
import warnings
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np

from haptic_glance.base.files import read_table, write_json
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.engine.statistics import interval_tree

from . import COLUMNS, Params
from .measure import CLEAN, library_of, process

FIFTHS = 5
HEADLINES = {"blind": 1, "look": 1, "look_told": 1, "siblings": 1}  # sight: touches, in the metrics


def classes_of(folder: Path, names: list[str]) -> dict[str, str]:
    """{object: class}: of classes.csv in a folder of meshes, else what precedes `_NUMBER` in its name."""
    if (folder / "classes.csv").exists():
        table = read_table(folder / "classes.csv")
        known = dict(zip(table["object"], table["class"], strict=True))
        return {name: known.get(name, name) for name in names}
    return {name: re.sub(r"_\d+$", "", name) for name in names}


def reliability(rows: Rows) -> list[dict[str, Any]]:
    """Rows `reliable` of each sight and way: the share of right answers, and what was stated, in each fifth."""
    answers = defaultdict(list)
    for row in rows:
        answers[row["sight"], row["method"]] += row.get("_answers") or []
    found = []
    for (sight, method), pairs in answers.items():
        stated, right = np.array(sorted(pairs)).reshape(-1, 2).T
        for part in np.array_split(np.arange(len(stated)), FIFTHS):
            if len(part):
                found.append({
                    "metric": "reliable", "sight": sight, "method": method, "perturbation": CLEAN, "severity": 0.0,
                    "value": float(right[part].mean()), "stated": float(stated[part].mean()), "answers": len(part),
                })  # fmt: skip
    return found


def summary(rows: Rows, seed: int) -> dict[str, Any]:
    """{sight: {way: {right, touches_to_sure: {mean, low, high}}}} for the metric file."""
    values = defaultdict(list)
    for row in rows:
        if row["perturbation"] == CLEAN and row["metric"] in ("right", "touches_to_sure") and row["sight"] in HEADLINES:
            if row["metric"] == "right" and row["touches"] != HEADLINES[row["sight"]]:
                continue
            values[row["sight"], row["method"], row["metric"]].append(row["value"])
    return interval_tree(values, seed)


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings, folder = workspace.settings(Params), workspace.data / "meshes"
    with StageRun(workspace, "look_and_touch", COLUMNS, inputs=("meshes", "salient_points")) as stage:
        with warnings.catch_warnings(action="ignore"):  # objects that are alike are left out here, and said at the end
            alike = library_of(folder, tuple(stage.objects)).alike
        names = [name for name in stage.objects if name not in alike]
        if len(names) < 2:
            raise ValueError(f"look_and_touch: {workspace.dataset} has {len(names)} objects: two are needed")
        classes = classes_of(folder, names)
        work = functools.partial(
            process, data=workspace.data, names=names, classes=classes, settings=settings, seed=stage.seed
        )
        rows = stage.each(work, names, reads=("meshes", "salient_points/{}.npz"))
        stage.rows += reliability(rows)
        write_json(stage.folder / "names.json", classes)
        stage.metrics(summary(rows, stage.seed))
    left_out = f"; the same shapes as others: {', '.join(sorted(alike))}" if alike else ""
    print(f"look_and_touch: {workspace.dataset}, {len(names)} objects, {len(rows)} rows{left_out}")


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "look_and_touch"))
