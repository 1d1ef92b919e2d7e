"""Disturbs a few objects in many ways and measures what each method finds again, and where it breaks.

Reads data/SET/meshes and data/SET/weights. Writes reports/measurements/SET/stability.csv.gz: one row per object,
method, perturbation, severity and metric.
`repeatability`: share of the points found again within 2 % of the diagonal; `chance`: the same of random points;
`drift`: one minus the correlation of the saliency; `points`: how many of the points pass the method's own threshold.
Perturbation `none` is the object as it is. Seconds include an even share of the rendering and the maps that all methods
share. Settings: section `stability` of params.yaml.
"""

import dataclasses
import functools
from collections.abc import Sequence
from pathlib import Path

from haptic_glance.base.files import read_mesh
from haptic_glance.look.points.methods import split_runnable
from haptic_glance.look.points.options import Options
from haptic_glance.look.weights import read_learned_weights
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments

from . import COLUMNS, Params
from .breaking import summarise
from .subject import Subject


def process(name: str, folder: Path, data: Path, settings: Params, seed: int) -> Rows:
    """Disturbs one object in every way and at every severity; returns the rows."""
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    learned = read_learned_weights(data / "weights", name, mesh)
    methods, _ = split_runnable(settings.methods, learned)
    subject = Subject(mesh, methods, Options(learned, seed=seed, name=name), settings.count, settings.size)
    rows = subject.unperturbed_rows()
    for perturbation in settings.perturbations:
        for severity in settings.severities[perturbation]:
            rows += subject.rows(perturbation, severity)
    return rows


def check(settings: Params) -> None:
    """Raises ValueError that names a setting with which nothing can be measured."""
    if not settings.perturbations or not settings.methods:
        raise ValueError("stability.perturbations and stability.methods must name at least one each")
    bare = [name for name in settings.perturbations if not settings.severities.get(name)]
    if bare:
        raise ValueError(f"stability.severities has none for {', '.join(bare)}: give at least one")
    if min(settings.count, settings.most) < 1:
        raise ValueError("stability: count and most must be 1 or more")


def chosen(settings: Params, names: Sequence[str]) -> Sequence[str]:
    """The objects to disturb: those of the settings that are there, or else the first of all."""
    selected = [name for name in settings.objects if name in names] or names
    return selected[: settings.most]


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    check(settings)
    common = dataclasses.replace(settings, objects=[], most=0)  # what an object depends on
    with StageRun(workspace, "stability", COLUMNS, inputs=("meshes", "weights")) as stage:
        objects = chosen(settings, stage.objects)
        work = functools.partial(process, data=workspace.data, settings=common, seed=stage.seed)
        summary = summarise(stage.each(work, objects, reads=("meshes/{}.npz", "weights")))
        stage.metrics(summary)
    broken = sum(value is not None for value in summary["breaking_point"].values())
    print(
        f"stability: {len(objects)} objects, {len(settings.perturbations)} perturbations, "
        f"{broken} breaking points within range"
    )


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "stability"))
