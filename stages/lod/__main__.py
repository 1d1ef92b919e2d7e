"""Simplifies each mesh with its salient neighbourhoods kept, beside plain QEM, and measures the error (T3.1.3, T3.1.4).

Reads data/SET/meshes/NAME.npz, data/SET/salient_points/NAME.npz (the points past the method's own threshold) and, of
meshes with human gaze, that gaze spread over the surface from data/SET/weights/ground_truth/NAME.npz: metric
`salient_error` is the distance weighted by the saliency of our own model, `gaze_error` by that gaze, measured where
there is some. Writes data/SET/lod/NAME/METHOD_TARGET.npz and reports/measurements/SET/lod.csv.gz: one row per metric;
the same rows without seconds and notes go to data/SET/lod/NAME/curve.csv, for later stages. Seconds are those of the
simplification on rows `faces` (with the shrinking of neighbourhoods), elsewhere those of the one call that measured the
metric, pictures included (the object's own are made once). Where two methods keep the same faces the mesh is made and
measured once. Settings: section `lod` of params.yaml.

`haptic-glance simplify` simplifies a mesh of your own.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays, read_mesh, write_table
from haptic_glance.base.lazy import pandas as pd
from haptic_glance.lod.perceptual import take_pictures
from haptic_glance.look.views import viewpoint_set
from stages.engine.rows import some_rows
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.meshes import Params as MeshesParams
from stages.salient_points.measure import read_saliency, read_strong_points

from . import COLUMNS, Params
from .cell import ObjectInputs, measure_cells, warm_up

READS = ("meshes/{}.npz", "salient_points/{}.npz")
GAZE = "weights/ground_truth/{}.npz"
GAZED = ("gaze", "gaze_clouds")  # sources whose ground truth is gaze; that of others is marks


def process(name: str, folder: Path, data: Path, settings: Params, seed: int, gaze: bool) -> Rows:
    """Simplifies one object by every method to every target; gaze: measure the error weighted by human gaze, too."""
    warm_up(settings.backend)
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    path = data / "salient_points" / f"{name}.npz"
    height, width = settings.size
    pictures = take_pictures(mesh, viewpoint_set(settings.viewpoints), (height, width))
    looked_at = human_gaze(data / GAZE.format(name)) if gaze else None
    subject = ObjectInputs(name, mesh, read_strong_points(path), read_saliency(path), pictures, looked_at)
    rows = [row for method in settings.methods for row in measure_cells(subject, method, folder, settings, seed)]
    write_table(folder / name / "curve.csv", pd.DataFrame(rows).drop(columns=["seconds", "note"]))
    return rows


def human_gaze(path: Path) -> np.ndarray | None:
    """(n,) density of recorded gaze on an object, from its file of data/SET/weights/ground_truth; None without one."""
    return read_arrays(path)["density"] if path.exists() else None


SUMMARY_COLUMNS = ("item", "method", "target", "metric", "value", "infeasible", "shrunk")
METRICS = ("metro_mean", "ssim_error", "salient_error")


def summarise(rows: Sequence[dict]) -> dict[str, int | float | None]:
    """dict of mean errors per method over the cells (object, target) for which every method has a mesh (paired).

    A method without any mesh has None and is left out of the pairing. Also the number of such cells and of meshes, and
    the shares of infeasible cells and of those with shrunk neighbourhoods, over all and per method, among the cells
    that ask for fewer faces than the object has.
    """
    table = some_rows(rows, SUMMARY_COLUMNS, ("faces", *METRICS))
    cells = pd.DataFrame(table[(table["metric"] == "faces") & (table["value"].notna() | table["infeasible"])])
    methods = list(dict.fromkeys(table["method"]))
    summary: dict[str, int | float | None] = {"meshes": len(cells.dropna(subset="value"))}
    summary["paired_cells"] = len(paired(table, "faces"))
    for share in ("infeasible", "shrunk"):
        summary[f"share_{share}"] = round(float(cells[share].to_numpy().mean()), 6)
        by_method = pd.Series(cells.groupby("method")[share].mean())
        summary |= {
            f"{share}_{method}": round(float(by_method[method]), 6) for method in methods if method in by_method
        }
    for metric in METRICS:
        means = paired(table, metric).mean()
        summary |= {f"{metric}_{method}": _rounded(means.get(method)) for method in methods}
    return summary


def paired(table: pd.DataFrame, metric: str) -> pd.DataFrame:
    """Frame of one metric, one column per method, one row per cell for which all methods have a mesh."""
    wide = table[table["metric"] == metric].pivot(index=["item", "target"], columns="method", values="value")
    return wide.astype(float).dropna(axis="columns", how="all").dropna()


def _rounded(value):
    return None if value is None or pd.isna(value) else round(float(value), 9)


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    if not settings.methods or not settings.targets:
        raise ValueError("lod.methods and lod.targets must name at least one each")
    gaze = workspace.settings(MeshesParams).source in GAZED
    with StageRun(workspace, "lod", COLUMNS, inputs=("meshes", "weights", "salient_points")) as stage:
        work = functools.partial(process, data=workspace.data, settings=settings, seed=stage.seed, gaze=gaze)
        rows = stage.each(work, stage.objects, (*READS, GAZE) if gaze else READS)
        summary = summarise(rows)
        stage.metrics(summary)
    print(
        f"lod: {workspace.dataset}, {len(stage.objects)} objects, {summary['meshes']} meshes, "
        f"{summary['paired_cells']} cells with a mesh by every method, {summary['share_infeasible']:.1%} infeasible, "
        f"{summary['share_shrunk']:.1%} with smaller neighbourhoods than asked for"
    )


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "lod"))
