"""Finds the fewest faces of every object of a scene along a camera path, beside other ways to choose (T3.1.3).

Reads data/SET/meshes, data/SET/salient_points and data/SET/lod (the curves that the thesis's network learns from).
Writes data/SET/scene/levels/NAME (the levels, and their errors), data/SET/scene/plans (our levels at each tolerance),
data/SET/scene/plan.csv (one row per object and frame), data/SET/scene/pictures.npz (frames for the report),
data/SET/scene/export (one GLB per level, manifest.json) and reports/measurements/SET/scene.csv.gz: one row per method
and metric, over all frames or of one. Seconds are those of one plan, its rendering included; what an earlier plan
rendered is not rendered again, but for the network, which starts anew. Settings: section `scene` of params.yaml.
"""

import functools
from pathlib import Path

from haptic_glance.base.timing import Stopwatch
from haptic_glance.lod.scene.chain import build_lod_chain
from haptic_glance.lod.task import variant
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments

from . import COLUMNS, Params
from .compare import OURS, PLAIN, write_chain
from .level_files import export
from .measure import (
    CURVE,
    MESH,
    POINTS,
    Case,
    evaluation_rows,
    measure,
    measure_network,
    read_object,
    report_missing,
    scene_of,
)
from .rows import summary

LEVELS, PLAN = "scene/levels", "scene/plans/{}.npz"  # what earlier items of the run have made


def levels_of(name: str, folder: Path, data: Path, method: str, seed: int) -> Rows:
    """Builds the chains of one object; returns one row for each, with the seconds."""
    mesh, options, _ = read_object(data, name, method)
    rows = []
    for kind, arguments in ((OURS, options), (PLAIN, {})):
        with Stopwatch() as watch:
            levels = build_lod_chain(mesh, seed=seed, **arguments)
        write_chain(folder / "levels" / name, kind, levels)
        row = {"item": name, "method": kind, "frame": "all", "metric": "levels", "value": len(levels)}
        rows.append(row | {"seconds": watch.seconds})
    return rows


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings, data = workspace.settings(Params), workspace.data
    variant(settings.method)
    with StageRun(workspace, "scene", COLUMNS, inputs=("meshes", "salient_points", "lod")) as stage:
        scene, missing = scene_of(settings, stage.objects)
        report_missing(settings, scene, missing)
        names = sorted({placed.name for placed in scene.objects})
        other_objects = [name for name in stage.objects if name not in names]
        chains = functools.partial(levels_of, data=data, method=settings.method, seed=stage.seed)
        stage.each(chains, names, reads=(MESH, POINTS))
        factors = dict.fromkeys([1.0, *settings.factors])
        cases = {case.name: case for case in (Case(settings, factor) for factor in factors)}
        values = {name: repr(case) for name, case in cases.items()}
        files = [pattern.format(name) for name in names for pattern in (MESH, POINTS)]
        learned_from = [pattern.format(name) for name in other_objects for pattern in (MESH, CURVE)]
        common = {"data": data, "made": stage.folder, "shown": names, "seed": stage.seed}
        rows = [*stage.each(functools.partial(measure, **common), cases, [*files, LEVELS], values)]
        network = functools.partial(measure_network, **common, others=other_objects)
        rows += stage.each(network, cases, [*files, *learned_from, LEVELS, PLAN], values)
        stage.rows = [{"group": settings.name} | row for row in stage.rows]
        stage.rows += evaluation_rows(data, stage.objects, stage.seed, stage.map)
        export(stage.folder, data, scene, settings)
        numbers = summary(rows)
        stage.metrics(numbers)
    print(
        f"scene: {workspace.dataset}, {settings.name}, {len(names)} objects, {len(scene.cameras)} frames: "
        f"{numbers['faces_ours']:.0f} faces per frame of {numbers['faces_full']:.0f}, "
        f"{numbers['saved_uniform_error']:.0%} fewer than uniform levels at equal error, "
        f"{numbers['held_ours']:.0%} of frames within the tolerance"
    )


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "scene"))
