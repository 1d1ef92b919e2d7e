"""Simplifies each mesh with its salient neighbourhoods kept, beside plain QEM, and measures the error (T3.1.3, T3.1.4).

Reads data/meshes/NAME.npz, data/salient_points/NAME.npz (the points past the method's own threshold) and, of meshes
with human gaze, that gaze spread over the surface from data/weights/lessons/NAME.npz: metric `salient_error` is the
distance weighted by the saliency of our own model, `gaze_error` by that gaze, measured where there is some. Writes
data/lod/NAME/METHOD_TARGET.npz and reports/measurements/lod.csv: a row a metric; the same rows without seconds and
notes go to data/lod/NAME/curve.csv, for later stages. Seconds are those of the simplification on rows `faces` (with the
shrinking of neighbourhoods), elsewhere those of the one call that measured the metric, pictures included (the object's
own are made once). Where two methods keep the same faces the mesh is made and measured once. Settings: section `lod`
of params.yaml.

A mesh of your own, instead, from file to file:
  python -m stages.lod bunny.stl --faces 1500 --out small.glb
  python -m stages.lod bunny.stl --help
"""

import functools
import sys

import pandas as pd

from stages.kit import StageRun, arguments, params
from stages.kit.files import read_arrays, read_mesh, write_table
from stages.kit.run import DATA, errors_in_one_line
from stages.salient_points import read_saliency, read_strong_points
from stages.views import viewpoint_set

from .cell import Subject, measure_cells
from .perceptual import take_pictures
from .simplify import check_backend
from .summary import summarise
from .targets import face_count
from .variant import variant
from .warm_up import warm_up


def process(name, folder, settings, seed, source):
    """Simplifies one object, from a data set `source`, by every method to every target; returns the rows."""
    warm_up(settings.backend)
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    found = DATA / "salient_points" / f"{name}.npz"
    pictures = take_pictures(mesh, viewpoint_set(settings.viewpoints), tuple(settings.size))
    subject = Subject(name, mesh, read_strong_points(found), read_saliency(found), pictures, human_gaze(name, source))
    rows = [row for method in settings.methods for row in measure_cells(subject, method, folder, settings, seed)]
    write_table(folder / name / "curve.csv", pd.DataFrame(rows).drop(columns=["seconds", "note"]))
    return rows


def human_gaze(name, source):
    """(n,) density of recorded gaze on an object, or None: marks, the lessons of other data sets, are no gaze."""
    lesson = DATA / "weights" / "lessons" / f"{name}.npz"
    return read_arrays(lesson)["density"] if source == "gaze" and lesson.exists() else None


def main():
    if set(sys.argv[1:]) - {"-h", "--help"}:
        errors_in_one_line("lod")  # before an import that takes a second, in which a person may press Ctrl-C
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
    with StageRun("lod", inputs=("meshes", "weights", "salient_points")) as run:
        work = functools.partial(process, settings=settings, seed=run.seed, source=run.dataset)
        rows = run.each(work, run.objects)
        summary = summarise(rows)
        run.metrics(summary)
    print(
        f"lod: {len(run.objects)} objects, {summary['meshes']} meshes, "
        f"{summary['paired_cells']} cells that all methods reach, {summary['share_infeasible']:.1%} infeasible, "
        f"{summary['share_shrunk']:.1%} with smaller neighbourhoods than wished"
    )


if __name__ == "__main__":
    main()
