"""Disturbs the touches of a set of objects in many ways and measures where recognition breaks.

Reads meshes, imprints, salient_points and lod of the objects of one group (classification.sets) in data/SET.
Classifiers train on clean touches and recognise disturbed ones of other places; where the model is coarse, or touches
are few, the training touches are disturbed. Writes data/SET/touch_stability/NAME.npz (features, and the imprints
that are denoised) and reports/measurements/SET/touch_stability.csv.gz:
one row per split, features, classifier, perturbation, severity and repetition; `none` is clean touches, severity 0.
The metrics hold the breaking points: the severity at which half of the lead over guessing is lost.
"""

import functools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from haptic_glance.disturb.touch_disturbances import TOUCH_PERTURBATIONS
from haptic_glance.know import SPLITS
from stages.classification import Params as Classification
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.engine.statistics import breaking_point, lead_left
from stages.imprints.imprints import read_imprints

from . import COLUMNS, Params
from .disturbed_trials import CLEAN, process, trial


def summary(rows: Rows) -> dict[str, dict[str, Any]]:
    """{accuracy: {SPLIT.FEATURES.CLASSIFIER}, breaking_point: {....PERTURBATION}}; None where it does not break."""
    tree: dict[str, dict[str, Any]] = {"accuracy": {}, "breaking_point": {}}
    values: dict[str, dict[str, dict[float, list[float]]]] = {}  # of each model, perturbation and severity
    chances = {}
    for row in rows:
        if row["value"] is not None:
            model = ".".join([SPLITS[row["split"]], row["features"], row["classifier"]])
            by_severity = values.setdefault(model, {}).setdefault(row["perturbation"], {})
            by_severity.setdefault(row["severity"], []).append(row["value"])
            chances[model] = row["chance"]
    for model, by_perturbation in values.items():
        clean = float(np.mean(by_perturbation.pop(CLEAN)[0.0]))
        tree["accuracy"][model] = round(clean, 6)
        for perturbation, by_severity in by_perturbation.items():
            shares = lead_left([np.mean(numbers) for numbers in by_severity.values()], clean, chances[model])
            severity = breaking_point(list(by_severity), shares.tolist(), TOUCH_PERTURBATIONS[perturbation].unharmed)
            tree["breaking_point"][f"{model}.{perturbation}"] = round(severity, 6) if np.isfinite(severity) else None
    return tree


def check(settings: Params, sets: Mapping[str, list[str]]) -> None:
    """Raises ValueError that names a setting with which nothing can be measured."""
    if settings.set not in sets:
        raise ValueError(f"touch_stability.set: no set {settings.set}; classification.sets: {', '.join(sets)}")


def left_out(settings: Params, objects: list[str], folder: Path) -> tuple[str | None, int, float]:
    """(why the objects cannot be recognised by touch, or None; touches per object; the array's width).

    folder: data/SET/imprints.
    """
    if len(objects) < 2:
        return f"set {settings.set} left out: at least two objects are needed", 0, 0.0
    missing = [name for name in objects if not (folder / f"{name}.npz").exists()]
    if missing:
        return f"set {settings.set} left out: no imprints of {', '.join(missing)}", 0, 0.0
    imprint_files = [read_imprints(folder / f"{name}.npz") for name in objects]
    imprints = [by_method[settings.method] for by_method in imprint_files if settings.method in by_method]
    if len(imprints) < len(objects):
        return f"set {settings.set} left out: no imprints by {settings.method}", 0, 0.0
    return None, min(len(entry.images) for entry in imprints), max(entry.width for entry in imprints)


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings, sets = workspace.settings(Params), workspace.settings(Classification).sets
    check(settings, sets)
    objects = sorted(sets[settings.set])
    with StageRun(
        workspace, "touch_stability", COLUMNS, inputs=("meshes", "imprints", "salient_points", "lod")
    ) as stage:
        note, count, width = left_out(settings, objects, workspace.data / "imprints")
        if note:
            row = {"group": settings.set, "method": settings.method, "metric": "accuracy", "value": None, "note": note}
            stage.rows.append(row)
        else:
            common = {"settings": settings, "seed": stage.seed}
            disturb = functools.partial(process, data=workspace.data, count=count, **common)
            reads = ("meshes/{}.npz", "imprints/{}.npz", "salient_points/{}.npz", "lod/{}")
            stage.each(disturb, objects, reads)
            recognise = functools.partial(trial, made=stage.folder, objects=objects, width=width, **common)
            repetitions = [f"repetition {number}" for number in range(settings.repetitions)]
            stage.each(recognise, repetitions, reads=["touch_stability"])
        metrics = summary(stage.rows)
        stage.metrics(metrics)
    broken = sum(value is not None for value in metrics["breaking_point"].values())
    extent = note or f"{len(objects)} objects, {len(settings.severities)} perturbations"
    breaking = f"{broken} of {len(metrics['breaking_point'])} break within range"
    print(f"touch_stability: {workspace.dataset}, {extent}; {breaking}")


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "touch_stability"))
