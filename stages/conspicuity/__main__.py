"""Computes the conspicuity maps of every view: what stands out, channel by channel (T3.1.1, T3.2).

Reads data/SET/meshes/NAME.npz, data/SET/views/viewpoints.csv and data/SET/views/NAME/*.npz. Writes
data/SET/conspicuity/NAME.npz (maps, mask, viewpoints, channels) and reports/measurements/SET/conspicuity.csv.gz.
"""

import functools
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_mesh, read_table, write_arrays
from haptic_glance.base.lazy import cv2
from haptic_glance.look.channels.channels import mask_at_size
from haptic_glance.look.channels.cropped_view import FILLED
from haptic_glance.look.channels.printed import check_formulas
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.views.storage import read_view

from . import COLUMNS, Params
from .measure import background_rows, hue_rows, measured_maps


def process(name: str, folder: Path, data: Path, settings: Params) -> Rows:
    """Maps all views of one object; returns what each channel cost and how much of it lies along the silhouette."""
    cv2.setNumThreads(1)  # a worker is one core, and `seconds` are of one core
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    channels, (height, width) = list(settings.channels), settings.size
    filled = settings.background == FILLED
    size = (height, width)
    viewpoints = list(read_table(data / "views" / "viewpoints.csv")["viewpoint"])
    maps = np.zeros((len(viewpoints), len(channels), *size), dtype=np.float16)
    mask = np.zeros((len(viewpoints), *size), dtype=bool)
    rows = []
    for k, viewpoint in enumerate(viewpoints):
        view = read_view(data / "views" / name / f"{viewpoint}.npz")
        view_maps, cost_rows = measured_maps(mesh, view, channels, size, filled, settings.symmetry, settings.formulas)
        maps[k] = [view_maps[channel] for channel in channels]
        mask[k] = mask_at_size(view.mask, size)
        rows += cost_rows
        if k == 0 and settings.compare_background:
            rows += background_rows(mesh, view, channels, size, settings.formulas)
            rows += hue_rows(mesh, view, view_maps, size, filled, settings.formulas)
    write_arrays(folder / f"{name}.npz", maps=maps, mask=mask, viewpoints=viewpoints, channels=channels)
    return [{"item": name} | row for row in rows]


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    check_formulas(settings.formulas, settings.background == FILLED)
    with StageRun(workspace, "conspicuity", COLUMNS, inputs=("meshes", "views")) as stage:
        work = functools.partial(process, data=workspace.data, settings=settings)
        rows = stage.each(work, stage.objects, reads=("meshes/{}.npz", "views/{}", "views/viewpoints.csv"))
        maps = [(row["value"], row["seconds"]) for row in rows if row["metric"] == "silhouette_share"]
        share = float(np.mean([value for value, _ in maps if value is not None] or [0]))
        stage.metrics({"maps": len(maps), "silhouette_share": round(share, 6)})
    seconds = sum(seconds for _, seconds in maps)
    print(
        f"conspicuity: {len(stage.objects)} objects, {len(maps)} maps in {seconds:.0f} s of one core, "
        f"{share:.2f} of an even share along the silhouette"
    )


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "conspicuity"))
