"""How much looking does the model of where people look need? `python -m benchmarks.attention FOLDER`.

FOLDER: a run of the pipeline on meshes with human gaze (`make gaze` leaves one in build/gaze). Every set of
viewpoints, image size and choice of channels is learned leaving each mesh out and judged on it; writes
reports/attention/settings.csv: object, views, rows, channels, method (fixations or equal weights), nss, auc, seconds of
one core for that object from mesh to saliency, seconds of the reference (itti, twelve views, 900 rows) in the same run.
"""

import os
from pathlib import Path

import cv2
import numpy as np
import pandas as pd

from benchmarks import arguments
from stages.conspicuity import CHANNELS, Sight, conspicuity, facing
from stages.conspicuity.channels import coverage
from stages.kit import Stopwatch
from stages.kit.files import read_arrays, read_mesh, write_table
from stages.kit.parallel import progress
from stages.salient_points import COMBINATIONS, best_viewpoints
from stages.views import FOUR, TWELVE, greedy_views, render
from stages.weights import fit_fixations, fixation_density, vertex_features
from stages.weights.agreement import Truth, auc, nss
from stages.weights.features import SEEN

OUT = Path("reports/attention/settings.csv")
VIEWS = {
    "one": lambda mesh: TWELVE[:1],
    "two": lambda mesh: (FOUR[0], FOUR[2]),
    "four": lambda mesh: FOUR,
    "greedy four": lambda mesh: greedy_views(mesh, 4)[0],
    "best": best_viewpoints,
    "twelve": lambda mesh: TWELVE,
}
CHOICES = {
    "none": (),
    "symmetry": SEEN,
    "orientation, symmetry": ("orientation", "symmetry"),
    "edge, orientation, symmetry": ("edge", "orientation", "symmetry"),
    "curvature, symmetry": ("curvature", "symmetry"),
    "itti": COMBINATIONS["VisAtt"],
    "itti, symmetry": (*COMBINATIONS["VisAtt"], "symmetry"),
    "nine": tuple(CHANNELS),
    **{f"nine without {name}": tuple(set(CHANNELS) - {name}) for name in CHANNELS},
}


FULL = ("twelve", 900)  # where every choice of channels is judged; elsewhere FEW
FEW = ("none", "symmetry", "orientation, symmetry", "nine")


def seen(mesh, viewpoints, rows):
    """(Sight, dict part -> seconds): all nine maps at one image size, each part timed."""
    size, shape = (rows, rows * 4 // 3), (rows // 4, rows // 3)
    seconds = dict.fromkeys(("pictures", "facing", *CHANNELS), 0.0)
    found, masks = [], []
    for viewpoint in viewpoints:
        with Stopwatch() as watch:
            view = render(mesh, viewpoint, size, "raycast")
        seconds["pictures"] += watch.seconds
        maps = {}
        for channel in CHANNELS:
            with Stopwatch() as watch:
                maps |= conspicuity(mesh, view, [channel], shape)
            seconds[channel] += watch.seconds
        found.append(maps)
        masks.append(coverage(view.mask, shape))
    with Stopwatch() as watch:
        sight = Sight(mesh, viewpoints, {c: np.stack([maps[c] for maps in found]) for c in CHANNELS}, np.stack(masks))
    seconds["sight"] = watch.seconds
    with Stopwatch() as watch:
        facing(mesh, viewpoints)
    seconds["facing"] = watch.seconds
    return sight, seconds


def measured(mesh, viewpoints, rows):
    """(dict feature -> (n,), dict channel -> (n,) on the vertices, dict part -> seconds)."""
    sight, seconds = seen(mesh, viewpoints, rows)
    on_vertices = {}
    for channel in CHANNELS:
        with Stopwatch() as watch:
            on_vertices[channel] = sight.averaged(sight.maps[channel])
        seconds[channel] += watch.seconds
    with Stopwatch() as watch:
        features = vertex_features(mesh, sight.viewpoints, sight.facing, on_vertices)
    return features, on_vertices, seconds | {"features": watch.seconds}


def cost(seconds, channels, model):
    """Seconds of what a choice of channels needs: without channels no picture is taken."""
    parts = ["facing", "features"] if model == "fixations" else []
    if channels:
        parts = ["pictures", "sight", *channels, *(["features"] if model == "fixations" else [])]
    return sum(seconds[part] for part in parts)


def judge(setting, meshes, truths):
    """Rows of one set of views and image size, for every choice of channels, leaving each mesh out."""
    views, rows = setting
    looked = {
        name: measured(mesh, VIEWS[views](mesh), rows) for name, mesh in progress(meshes.items(), f"{views} {rows}")
    }
    found = []
    for choice, channels in CHOICES.items():
        if setting != FULL and choice not in FEW:
            continue
        names = [name for name in next(iter(looked.values()))[0] if name in channels or name not in CHANNELS]
        stacked = {
            mesh: np.stack([features[name] for name in names], axis=1) for mesh, (features, _, _) in looked.items()
        }
        for mesh, (features, maps, seconds) in looked.items():
            others = [other for other in looked if other != mesh]
            learned = fit_fixations(
                [stacked[other] for other in others],
                [truths[other].amounts for other in others],
                [truths[other].areas for other in others],
            )
            answers = {"fixations": fixation_density(features, dict(zip(names, learned, strict=True)))}
            if channels:
                answers["equal"] = sum(maps[channel] for channel in channels)
            found += [
                {
                    "object": mesh, "views": views, "rows": rows, "channels": choice, "method": model,
                    "nss": nss(answer, truths[mesh]), "auc": auc(answer, truths[mesh]),
                    "seconds": cost(seconds, channels, model),
                }
                for model, answer in answers.items()
            ]  # fmt: skip
    return found


def main():
    folder = Path(arguments(__doc__, "folder").folder) / "data"
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    cv2.setNumThreads(1)
    names = sorted(path.stem for path in (folder / "weights/lessons").glob("*.npz"))
    meshes = {name: read_mesh(folder / f"meshes/{name}.npz") for name in names}
    lessons = {name: read_arrays(folder / f"weights/lessons/{name}.npz") for name in names}
    truths = {name: Truth(lesson["amounts"], lesson["density"], lesson["areas"]) for name, lesson in lessons.items()}
    rows = []
    others = [*((views, 900) for views in VIEWS if views != FULL[0]), ("twelve", 450), ("twelve", 225), ("four", 450)]
    for setting in [FULL, *others]:
        rows += judge(setting, meshes, truths)
        write_table(OUT, pd.DataFrame(rows))
        print(f"attention: {setting[0]} views at {setting[1]} rows judged", flush=True)


if __name__ == "__main__":
    main()
