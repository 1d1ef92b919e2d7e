"""Simplifies each mesh with its salient neighbourhoods kept, beside plain QEM, and measures the error (T3.1.3, T3.1.4).

Reads data/meshes/NAME.npz and data/salient_points/NAME.npz (the points past the method's own threshold). Writes
data/lod/NAME/METHOD_TARGET.npz and reports/measurements/lod.csv: a row a metric. Seconds are those of the
simplification on rows `faces`, those of the one Metro call on the three metro rows, and those of the simplified mesh's
pictures and their comparison on ssim_error (the object's own pictures are made once). Settings: section `lod` of
params.yaml.
"""

import functools

from stages.kit import StageRun, arguments, params
from stages.kit.files import read_mesh
from stages.kit.run import DATA
from stages.salient_points import METHODS, read_strong_points
from stages.views import viewpoint_set

from .cell import PLAIN, Subject, measure_cells
from .perceptual import take_pictures
from .simplify import check_backend
from .summary import summarise
from .targets import face_count


def process(name, folder, settings, seed):
    """Simplifies one object by every method to every target; returns the rows."""
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    points = read_strong_points(DATA / "salient_points" / f"{name}.npz")
    pictures = take_pictures(mesh, viewpoint_set(settings.viewpoints), tuple(settings.size))
    subject = Subject(name, mesh, points, pictures)
    return [row for method in settings.methods for row in measure_cells(subject, method, folder, settings, seed)]


def main():
    arguments(__doc__)
    settings = params("lod")
    check_backend(settings.backend)
    for target in settings.targets:
        face_count(target, 1)
    unknown = [method for method in settings.methods if method not in (PLAIN, *METHODS)]
    if unknown or not settings.methods or not settings.targets:
        raise ValueError(f"lod.methods or lod.targets: {unknown or 'empty'}; methods are {PLAIN}, {', '.join(METHODS)}")
    with StageRun("lod", inputs=("meshes", "salient_points")) as run:
        rows = run.each(functools.partial(process, settings=settings, seed=run.seed), run.objects)
        summary = summarise(rows)
        run.metrics(summary)
    print(
        f"lod: {len(run.objects)} objects, {summary['meshes']} meshes, "
        f"{summary['paired_cells']} cells that all methods reach, {summary['share_infeasible']:.1%} infeasible"
    )


if __name__ == "__main__":
    main()
