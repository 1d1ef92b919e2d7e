"""Simplifies each mesh with its salient neighbourhoods kept, beside plain QEM, and measures the error (T3.1.3, T3.1.4).

Reads data/meshes/NAME.npz and data/salient_points/NAME.npz (the points past the method's own threshold). Writes
data/lod/NAME/METHOD_TARGET.npz and reports/measurements/lod.csv: a row a metric; the same rows without seconds and
notes go to data/lod/NAME/curve.csv, for later stages. Seconds are those of the simplification on rows `faces` (with the
shrinking of neighbourhoods), elsewhere those of the one call that measured the metric, pictures included (the object's
own are made once). Where two methods keep the same faces the mesh is made and measured once. Settings: section `lod`
of params.yaml. With a mesh file it simplifies that one: `python -m stages.lod MESH --help`.
"""

import functools
import sys

import pandas as pd

from stages.kit import StageRun, arguments, params
from stages.kit.files import read_mesh, write_table
from stages.kit.run import DATA
from stages.salient_points import read_saliency, read_strong_points
from stages.views import viewpoint_set

from .cell import Subject, measure_cells
from .perceptual import take_pictures
from .simplify import check_backend
from .summary import summarise
from .targets import face_count
from .variant import variant


def process(name, folder, settings, seed):
    """Simplifies one object by every method to every target; returns the rows."""
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    found = DATA / "salient_points" / f"{name}.npz"
    pictures = take_pictures(mesh, viewpoint_set(settings.viewpoints), tuple(settings.size))
    subject = Subject(name, mesh, read_strong_points(found), read_saliency(found), pictures)
    rows = [row for method in settings.methods for row in measure_cells(subject, method, folder, settings, seed)]
    write_table(folder / name / "curve.csv", pd.DataFrame(rows).drop(columns=["seconds", "note"]))
    return rows


def main():
    if any(not word.startswith("-") for word in sys.argv[1:]):
        from .command import run  # the pipeline needs neither its writers nor its pictures

        run(sys.argv[1:])
        return
    arguments(__doc__)
    settings = params("lod")
    check_backend(settings.backend)
    for target in settings.targets:
        face_count(target, 1)
    for method in settings.methods:
        variant(method)
    if not settings.methods or not settings.targets:
        raise ValueError("lod.methods and lod.targets must name at least one each")
    with StageRun("lod", inputs=("meshes", "salient_points")) as run:
        rows = run.each(functools.partial(process, settings=settings, seed=run.seed), run.objects)
        summary = summarise(rows)
        run.metrics(summary)
    print(
        f"lod: {len(run.objects)} objects, {summary['meshes']} meshes, "
        f"{summary['paired_cells']} cells that all methods reach, {summary['share_infeasible']:.1%} infeasible, "
        f"{summary['share_shrunk']:.1%} with smaller neighbourhoods than wished"
    )


if __name__ == "__main__":
    main()
