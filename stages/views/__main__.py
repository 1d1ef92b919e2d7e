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

from . import render, viewpoint_set, write_view
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
    return rows


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
        coverage = float(np.mean([row["value"] for row in rows])) if rows else 0.0
        run.metrics({"views": len(rows), "coverage": round(coverage, 6)})
    print(
        f"views: {len(run.objects)} objects, {len(rows)} views by {renderer}, {coverage:.1%} of the pixels on objects"
    )


if __name__ == "__main__":
    main()
