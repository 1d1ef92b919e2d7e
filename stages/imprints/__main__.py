"""Presses the virtual pressure array on every object at the points of its methods (T4.3).

Reads data/meshes/NAME.npz and data/salient_points/NAME.npz, writes data/imprints/NAME.npz and
reports/measurements/imprints.csv: for each object and method the number of imprints, their mean relief in units of the
object, the share of cells that felt nothing within reach, and the points that could not be touched.

A mesh of your own, instead, with a picture of what the array feels and where:
  python -m stages.imprints bunny.stl --at salient
  python -m stages.imprints bunny.stl --help
"""

import functools
import sys

import numpy as np

from stages.kit import StageRun, Stopwatch, arguments, params
from stages.kit.files import read_mesh
from stages.kit.run import DATA, errors_in_one_line
from stages.salient_points import read_points

from .contact import check_contact
from .distances import check_sensor, distances
from .files import Imprints, write_imprints
from .frame import touchable
from .press import normalise
from .surface import Surface
from .warm_up import warm_up


def process(name, folder, settings):
    """Touches one object at all points of all methods; writes its file and returns its rows."""
    warm_up()
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    surface, imprints, rows = Surface(mesh), {}, []
    found = read_points(DATA / "salient_points" / f"{name}.npz")
    for method in sorted(settings.methods):
        if method not in found:
            raise ValueError(f"imprints.methods: {method} is not among salient_points.methods: {', '.join(found)}")
        points = found[method]
        can = touchable(mesh, points)
        with Stopwatch() as watch:
            raw = distances(surface, points[can], settings.cells, settings.pitch, contact=settings.contact)
            images = normalise(raw, settings.pitch)
        imprints[method] = Imprints(images, points[can], mesh.vertices[points[can]], settings.pitch)
        values = {"imprints": len(images), **_shape_of(raw, settings), "refused": int((~can).sum())}
        common = {"object": name, "method": method}
        rows += [{**common, "metric": key, "value": value, "seconds": watch.seconds} for key, value in values.items()]
    write_imprints(folder / f"{name}.npz", imprints)
    return rows


def _shape_of(raw, settings):
    """Mean relief of the imprints in units, and the share of cells without a surface in reach."""
    if len(raw) == 0:
        return {"relief": None, "missed": None}
    _, _, reach = check_sensor(settings.cells, settings.pitch)
    return {"relief": float(np.ptp(raw, axis=(1, 2)).mean()), "missed": float((raw >= reach).mean())}


def main():
    if set(sys.argv[1:]) - {"-h", "--help"}:
        errors_in_one_line("imprints")  # before an import that takes a second, in which a person may press Ctrl-C
        from .command import run  # the pipeline needs neither its writers nor its pictures

        run(sys.argv[1:])
        return
    arguments(__doc__)
    settings = params("imprints")
    check_sensor(settings.cells, settings.pitch)
    check_contact(settings.contact)
    with StageRun("imprints", inputs=("meshes", "salient_points")) as run:
        rows = run.each(functools.partial(process, settings=settings), run.objects)
        total = {key: sum(row["value"] for row in rows if row["metric"] == key) for key in ("imprints", "refused")}
        relief = [row["value"] for row in rows if row["metric"] == "relief" and row["value"] is not None]
        missed = [row["value"] for row in rows if row["metric"] == "missed" and row["value"] is not None]
        means = {key: round(float(np.mean(v)), 6) for key, v in (("relief", relief), ("missed", missed)) if v}
        run.metrics({**total, **means})
        objects = len(run.objects)
    size = "x".join(map(str, settings.cells))
    print(f"imprints: {objects} objects, {total['imprints']} imprints of {size}, {total['refused']} points refused")


if __name__ == "__main__":
    main()
