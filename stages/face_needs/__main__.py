"""Finds the fewest faces with which each object is seen, felt and recognised as the full mesh is.

Reads data/SET/meshes, data/SET/salient_points and the levels of data/SET/scene. Writes data/SET/face_needs/NAME.npz
(what touches read on each level) and reports/measurements/SET/face_needs.csv.gz: a row an object, task and condition.
Seen: the picture is displaced by no more than a tolerance, from all round. Felt: imprints at the same places differ by
no more than a share of full scale. Recognised: touches of the real object are known by a model learned from the
simplified one, within some points of accuracy.
"""

import functools

import numpy as np

from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments

from . import COLUMNS, Params
from .need import process, recognise

READS = ("meshes/{}.npz", "meshes/manifest.csv", "salient_points/{}.npz", "scene/levels/{}")


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    with StageRun(workspace, "face_needs", COLUMNS, inputs=("meshes", "salient_points", "scene")) as stage:
        names = [name for name in stage.objects if (workspace.data / "scene/levels" / name).is_dir()]
        stage.each(functools.partial(process, data=workspace.data, settings=settings), names, READS)
        work = functools.partial(recognise, made=stage.folder, names=names, settings=settings, seed=stage.seed)
        stage.each(work, ["all objects"], ["face_needs"])
        medians = summary(stage.rows)
        stage.metrics(medians)
    text = ", ".join(f"{name} {value:.0f}" for name, value in medians.items())
    print(f"face_needs: {workspace.dataset}, {len(names)} objects; median faces: {text}")


def summary(rows: Rows) -> dict[str, float]:
    """{task, or task_condition: the median face count over the objects}."""
    counts: dict[str, list[float]] = {}
    for row in rows:
        if row["metric"] == "faces":
            name = row["task"] if row["condition"] is None else f"{row['task']}_{row['condition']:g}"
            counts.setdefault(name, []).append(row["value"])
    return {name: float(np.median(values)) for name, values in counts.items()}


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "face_needs"))
