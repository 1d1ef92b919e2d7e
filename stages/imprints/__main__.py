"""Presses the virtual pressure array on every object at the points of its methods (T4.2.3.1, T4.3).

Reads data/SET/meshes/NAME.npz and data/SET/salient_points/NAME.npz, writes data/SET/imprints/NAME.npz and
reports/measurements/SET/imprints.csv.gz: per object and method the number of imprints, their mean relief in units of
the object, the share of cells without a surface in range, and the points that could not be touched.

`haptic-glance touch` touches a mesh of your own.
"""

import functools
import sys
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_mesh
from haptic_glance.base.timing import Stopwatch
from haptic_glance.touch.distances import check_array
from haptic_glance.touch.press import warm_up
from haptic_glance.touch.quasi_tangent import Touched, misfit, touch
from haptic_glance.touch.surface import Surface
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.salient_points.measure import read_points

from . import Params
from .imprints import Imprints, write_imprints


def process(name: str, folder: Path, data: Path, settings: Params) -> Rows:
    """Touches one object at all points of all methods; writes its file and returns its rows."""
    warm_up()
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    surface, imprints, rows = Surface(mesh), {}, []
    cells = settings.cells[0], settings.cells[1]
    by_method = read_points(data / "salient_points" / f"{name}.npz")
    for method in sorted(settings.methods):
        if method not in by_method:
            raise ValueError(f"imprints.methods: {method} is not among salient_points.methods: {', '.join(by_method)}")
        with Stopwatch() as watch:
            felt = touch(surface, by_method[method], cells, settings.pitch, settings.contact)
        points = by_method[method][felt.can]
        imprints[method] = Imprints(felt.images, points, mesh.vertices[points], settings.pitch)
        values = {"imprints": len(points), **_shape_of(felt), "refused": int((~felt.can).sum())}
        common = {"item": name, "method": method}
        rows += [{**common, "metric": key, "value": value, "seconds": watch.seconds} for key, value in values.items()]
    write_imprints(folder / f"{name}.npz", imprints)
    return rows


def _shape_of(felt: Touched) -> dict[str, float | None]:
    """Mean relief of the imprints in units, and the share of cells without a surface in range."""
    if len(felt.depths) == 0:
        return {"relief": None, "missed": None}
    return {
        "relief": float(np.ptp(felt.depths, axis=(1, 2)).mean()), "missed": float((felt.depths >= felt.reach).mean())
    }  # fmt: skip


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    check_array(settings.cells, settings.pitch)
    if wrong := misfit(settings.cells, settings.pitch):
        print(f"imprints: {wrong}", file=sys.stderr)
    with StageRun(workspace, "imprints", inputs=("meshes", "salient_points")) as stage:
        work = functools.partial(process, data=workspace.data, settings=settings)
        rows = stage.each(work, stage.objects, reads=("meshes/{}.npz", "salient_points/{}.npz"))
        total = {key: sum(row["value"] for row in rows if row["metric"] == key) for key in ("imprints", "refused")}
        relief = [row["value"] for row in rows if row["metric"] == "relief" and row["value"] is not None]
        missed = [row["value"] for row in rows if row["metric"] == "missed" and row["value"] is not None]
        means = {key: round(float(np.mean(v)), 6) for key, v in (("relief", relief), ("missed", missed)) if v}
        stage.metrics({**total, **means})
        objects = len(stage.objects)
    size = "x".join(map(str, settings.cells))
    print(
        f"imprints: {workspace.dataset}, {objects} objects, {total['imprints']} imprints of {size}, "
        f"{total['refused']} points refused"
    )


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "imprints"))
