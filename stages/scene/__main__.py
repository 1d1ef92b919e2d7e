"""Finds the fewest faces of every object of a scene along a camera path, and compares them with other ways (T3.1.3).

Reads data/meshes, data/salient_points and data/lod (the curves that the thesis's network learns from). Writes
data/scene/levels/NAME (the levels, and their errors), data/scene/plan.csv (a row the level of an object in a frame),
data/scene/pictures.npz (frames for the report), data/scene/export (a GLB a level, manifest.json) and
reports/measurements/scene.csv: a row a method and metric, over all frames or of one. Seconds are those of one plan, its
rendering included; what an earlier plan rendered is not rendered again. Settings: section `scene` of params.yaml.
"""

import functools

from stages.kit import StageRun, Stopwatch, arguments, params
from stages.lod.variant import variant

from .compare import OURS, PLAIN
from .export import export
from .ladder import build_ladder
from .measure import measure
from .network import judged
from .read import read_object, say_missing, scene_of
from .rows import summary
from .storage import write_ladder


def levels_of(name, folder, settings, seed):
    """Builds the ladders of one object; returns a row each, with the seconds."""
    mesh, options, _ = read_object(name, settings.method)
    rows = []
    for kind, chosen in ((OURS, options), (PLAIN, {})):
        with Stopwatch() as watch:
            levels = build_ladder(mesh, seed=seed, **chosen)
        write_ladder(folder / "levels" / name, kind, levels)
        rows.append({"object": name, "method": kind, "frame": "all", "metric": "levels", "value": len(levels)}
                    | {"scene": settings.name, "seconds": watch.seconds})  # fmt: skip
    return rows


def main():
    arguments(__doc__)
    settings = params("scene")
    variant(settings.method)
    with StageRun("scene", inputs=("meshes", "salient_points", "lod")) as run:
        scene, missing = scene_of(settings, run.objects)
        say_missing(settings, scene, missing)
        names = sorted({placed.name for placed in scene.objects})
        run.each(functools.partial(levels_of, settings=settings, seed=run.seed), names)
        factors = {f"tolerance_{factor:g}": factor for factor in dict.fromkeys([1.0, *settings.factors])}
        job = functools.partial(measure, settings=settings, factors=factors, objects=run.objects, seed=run.seed)
        rows = run.each(job, list(factors))
        run.rows += judged(run.objects, run.seed)
        export(run.folder, settings, run.objects)
        found = summary(rows)
        run.metrics(found)
    print(
        f"scene: {settings.name}, {len(scene.objects)} objects, {len(scene.cameras)} frames: "
        f"{found['faces_ours']:.0f} faces a frame for {found['faces_full']:.0f}, "
        f"{found['saved_uniform_error']:.0%} fewer than uniform levels at equal error, "
        f"{found['held_ours']:.0%} of frames hold"
    )


if __name__ == "__main__":
    main()
