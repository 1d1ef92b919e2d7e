"""All objects of a data set, simplified by every method to every target."""

import functools
from pathlib import Path

import numpy as np
import pandas as pd

from haptic_glance.base.files import read_arrays, read_mesh, write_table
from haptic_glance.lod.perceptual import take_pictures
from haptic_glance.look.views import viewpoint_set
from stages.kit.run import Rows, StageRun
from stages.kit.workspace import Workspace
from stages.salient_points import read_saliency, read_strong_points

from .cell import measure_cells
from .inputs import ObjectInputs
from .schema import COLUMNS, Params
from .summary import summarise
from .warm_up import warm_up

READS = ("meshes/{}.npz", "salient_points/{}.npz")
GAZE = "weights/ground_truth/{}.npz"
GAZED = ("gaze", "gaze_clouds")  # sources whose ground truth is gaze; that of others is marks


def simplify_all(workspace: Workspace, settings: Params, source: str) -> str:
    """Runs the stage on a data set whose meshes come from `source`; returns one sentence on what was made."""
    with StageRun(workspace, "lod", COLUMNS, inputs=("meshes", "weights", "salient_points")) as stage:
        gaze = source in GAZED
        work = functools.partial(process, data=workspace.data, settings=settings, seed=stage.seed, gaze=gaze)
        rows = stage.each(work, stage.objects, (*READS, GAZE) if gaze else READS)
        summary = summarise(rows)
        stage.metrics(summary)
    return (
        f"lod: {workspace.dataset}, {len(stage.objects)} objects, {summary['meshes']} meshes, "
        f"{summary['paired_cells']} cells with a mesh by every method, {summary['share_infeasible']:.1%} infeasible, "
        f"{summary['share_shrunk']:.1%} with smaller neighbourhoods than asked for"
    )


def process(name: str, folder: Path, data: Path, settings: Params, seed: int, gaze: bool) -> Rows:
    """Simplifies one object by every method to every target; gaze: measure the error weighted by human gaze, too."""
    warm_up(settings.backend)
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    found = data / "salient_points" / f"{name}.npz"
    height, width = settings.size
    pictures = take_pictures(mesh, viewpoint_set(settings.viewpoints), (height, width))
    looked_at = human_gaze(data / GAZE.format(name)) if gaze else None
    subject = ObjectInputs(name, mesh, read_strong_points(found), read_saliency(found), pictures, looked_at)
    rows = [row for method in settings.methods for row in measure_cells(subject, method, folder, settings, seed)]
    write_table(folder / name / "curve.csv", pd.DataFrame(rows).drop(columns=["seconds", "note"]))
    return rows


def human_gaze(path: Path) -> np.ndarray | None:
    """(n,) density of recorded gaze on an object, from its file of data/SET/weights/ground_truth; None without one."""
    return read_arrays(path)["density"] if path.exists() else None
