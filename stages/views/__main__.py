"""Renders each mesh from a set of viewpoints (T3.1.1, T figure 3.2).

Reads data/SET/meshes/NAME.npz. Writes data/SET/views/NAME/VIEWPOINT.npz (stages.views.storage.read_view),
data/SET/views/viewpoints.csv and reports/measurements/SET/views.csv.gz.
"""

import functools
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_mesh, write_table
from haptic_glance.base.lazy import pandas as pd
from haptic_glance.base.timing import Stopwatch
from haptic_glance.look.views import VIEWPOINTS, cumulative_coverage, fewest_views, greedy_views, render, viewpoint_set
from haptic_glance.look.views.renderer import resolve_renderer
from haptic_glance.mesh.mesh import Mesh
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments

from . import COLUMNS, Params
from .storage import write_view


def process(name: str, folder: Path, data: Path, settings: Params, renderer: str) -> Rows:
    """Renders all views of one object; the first view's seconds include making the mesh ready."""
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    rows = []
    height, width = settings.size
    for viewpoint in viewpoint_set(settings.viewpoints):
        with Stopwatch() as watch:
            view = render(mesh, viewpoint, (height, width), renderer, settings.background, settings.material)
        write_view(folder / name / f"{viewpoint.name}.npz", view)
        row = {"item": name, "method": renderer, "viewpoint": viewpoint.name, "metric": "coverage"}
        rows.append(row | {"value": float(view.mask.mean()), "seconds": watch.seconds})
    return [*rows, *(seen_rows(name, mesh) if settings.compare_sets else [])]


def seen_rows(name: str, mesh: Mesh) -> Rows:
    """The share of the visible surface that 1, 2, ... views see together, and the fewest views that see 99 % of it."""
    rows = []
    for method, viewpoints in {"greedy": greedy_views(mesh)[0], **VIEWPOINTS}.items():
        with Stopwatch() as watch:
            shares = cumulative_coverage(mesh, viewpoints)
        row = {"item": name, "method": method, "metric": "seen_share", "seconds": watch.seconds}
        for views, (viewpoint, share) in enumerate(zip(viewpoints, shares, strict=True), start=1):
            rows.append(row | {"viewpoint": viewpoint.name, "views": views, "value": float(share)})
    with Stopwatch() as watch:
        views, _ = fewest_views(mesh)
    row = {"item": name, "method": "exact", "metric": "fewest_views"}
    return [*rows, row | {"value": len(views), "seconds": watch.seconds}]


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    viewpoints = viewpoint_set(settings.viewpoints)
    renderer = resolve_renderer(settings.renderer)
    with StageRun(workspace, "views", COLUMNS, inputs=("meshes",)) as stage:
        work = functools.partial(process, data=workspace.data, settings=settings, renderer=renderer)
        rows = stage.each(work, stage.objects, reads=("meshes/{}.npz",))
        table = [(v.name, float(v.azimuth), float(v.elevation), float(v.roll)) for v in viewpoints]
        columns = ["viewpoint", "azimuth", "elevation", "roll"]
        write_table(stage.folder / "viewpoints.csv", pd.DataFrame(table, columns=columns))
        shares = [row["value"] for row in rows if row["metric"] == "coverage"]
        fewest = [row["value"] for row in rows if row["metric"] == "fewest_views"]
        coverage = float(np.mean(shares)) if shares else 0.0
        metrics = {"views": len(shares), "coverage": round(coverage, 6)}
        stage.metrics(metrics | ({"fewest_views": round(float(np.mean(fewest)), 6)} if fewest else {}))
    count = f"{len(stage.objects)} objects, {len(shares)} views"
    print(f"views: {count} by {renderer}, {coverage:.1%} of the pixels on objects")


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "views"))
