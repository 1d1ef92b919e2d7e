"""Looks at each mesh from a set of viewpoints (T3.1.1, T figure 3.2).

Reads data/meshes/NAME.npz. Writes data/views/NAME/VIEWPOINT.npz (stages.views.read_view), data/views/viewpoints.csv and
reports/measurements/views.csv. Settings: section `views` of params.yaml.
"""

import functools

import numpy as np
import pandas as pd

from stages.kit import StageRun, Stopwatch, arguments, params
from stages.kit.files import read_mesh, write_table
from stages.kit.run import DATA

from . import VIEWPOINTS, fewest_views, greedy_views, render, seen_shares, viewpoint_set, write_view
from .renderer import choose


def process(name, folder, settings, renderer):
    """Renders all views of one object; the first view's seconds include making the mesh ready."""
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    rows = []
    for viewpoint in viewpoint_set(settings.viewpoints):
        with Stopwatch() as watch:
            view = render(mesh, viewpoint, tuple(settings.size), renderer, settings.background)
        write_view(folder / name / f"{viewpoint.name}.npz", view)
        row = {"object": name, "method": renderer, "viewpoint": viewpoint.name, "metric": "coverage"}
        rows.append(row | {"value": float(view.mask.mean()), "seconds": watch.seconds})
    return rows + seen_rows(name, mesh)


def seen_rows(name, mesh):
    """The share of the visible surface that 1, 2, ... views see together, and the fewest views that see 99 % of it."""
    rows = []
    for method, viewpoints in {"greedy": greedy_views(mesh)[0], **VIEWPOINTS}.items():
        with Stopwatch() as watch:
            shares = seen_shares(mesh, viewpoints)
        row = {"object": name, "method": method, "metric": "seen_share", "seconds": watch.seconds}
        for views, (viewpoint, share) in enumerate(zip(viewpoints, shares, strict=True), start=1):
            rows.append(row | {"viewpoint": viewpoint.name, "views": views, "value": float(share)})
    with Stopwatch() as watch:
        views, _ = fewest_views(mesh)
    row = {"object": name, "method": "exact", "metric": "fewest_views"}
    return [*rows, row | {"value": len(views), "seconds": watch.seconds}]


def main():
    arguments(__doc__)
    settings = params("views")
    viewpoints = viewpoint_set(settings.viewpoints)
    renderer = choose(settings.renderer)
    with StageRun("views", inputs=("meshes",)) as run:
        rows = run.each(functools.partial(process, settings=settings, renderer=renderer), run.objects)
        table = [(v.name, float(v.azimuth), float(v.elevation), float(v.roll)) for v in viewpoints]
        columns = ["viewpoint", "azimuth", "elevation", "roll"]
        write_table(run.folder / "viewpoints.csv", pd.DataFrame(table, columns=columns))
        shown = [row["value"] for row in rows if row["metric"] == "coverage"]
        fewest = [row["value"] for row in rows if row["metric"] == "fewest_views"]
        coverage = float(np.mean(shown)) if shown else 0.0
        metrics = {"views": len(shown), "coverage": round(coverage, 6)}
        run.metrics(metrics | {"fewest_views": round(float(np.mean(fewest or [0])), 6)})
    print(
        f"views: {len(run.objects)} objects, {len(shown)} views by {renderer}, {coverage:.1%} of the pixels on objects"
    )


if __name__ == "__main__":
    main()
