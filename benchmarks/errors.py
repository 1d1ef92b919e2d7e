"""The error measures, their time and their accuracy: `python -m benchmarks.errors`, on one core, about five minutes.

Writes reports/bench/errors.csv: a row a measurement (what, mesh, faces, method, samples, views, metric, value, sd,
seconds, ratio). `ratio` is pymeshlab's time over this one's, for the same work in the same run; `sd` is over seeds or
choices of views. Meshes are the objects of data/household/meshes and, where ../shared/data/psb.zip is, four from psb.
Seconds are medians of processor time of the calling thread, so that other work on the machine counts little.
"""

import functools
import io
import os
import time
import zipfile
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks import arguments
from haptic_glance.base.files import read_mesh, write_table
from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh

OUT = Path("reports/bench/errors.csv")
MESHES, PSB = Path("data/household/meshes"), Path("../shared/data/psb.zip")
HOUSEHOLD = ("spheremedium", "cup", "duck", "elephant")  # 2,000 to 10,776 faces
FROM_PSB = ("Airplane/61", "Human/1", "Vase/361", "Armadillo/281")  # 10,796 to 50,542 faces
SHARES = (0.5, 0.2, 0.1)
SAMPLES = (100, 300, 1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000)
TRUTH, RUNS, USUAL = 4_000_000, 7, 10_000
VIEWS = (1, 2, 3, 4, 6, 9, 12, 18, 24, 36, 48)
CHOICES = 200  # random choices of views


def meshes():
    """dict name -> Mesh."""
    from haptic_glance.mesh import load, normalise

    named = {name: read_mesh(MESHES / f"{name}.npz") for name in HOUSEHOLD if (MESHES / f"{name}.npz").exists()}
    if PSB.exists():
        with zipfile.ZipFile(PSB) as stored:
            for name in FROM_PSB:
                path = Path("build") / f"{name.replace('/', '_')}.off"
                path.parent.mkdir(exist_ok=True)
                path.write_bytes(io.BytesIO(stored.read(f"LabeledDB_new/{name}.off")).getvalue())
                named[name] = normalise(load(path))
                path.unlink()
    return named


def coarser(mesh, share):
    from haptic_glance.lod import simplify, smallest_feasible

    return simplify(mesh, max(int(len(mesh.faces) * share), smallest_feasible(mesh)), backend="pymeshlab")


def timed(call):
    start = time.thread_time()
    value = call()
    return time.thread_time() - start, value


def hausdorff(reference, mesh, samples, vertices):
    """A function that asks pymeshlab for the mean error, over the diagonal; the meshes are in its memory already."""
    import pymeshlab

    work = pymeshlab.MeshSet(verbose=False)
    for side in (reference, mesh):
        work.add_mesh(pymeshlab.Mesh(side.vertices, side.faces))

    def ask():
        sides = [
            work.apply_filter(
                "get_hausdorff_distance", sampledmesh=k, targetmesh=1 - k, savesample=False, samplevert=vertices,
                sampleedge=False, samplefauxedge=False, sampleface=True, samplenum=samples,
                maxdist=pymeshlab.PercentageValue(50),
            )
            for k in (0, 1)
        ]  # fmt: skip
        return max(side["mean"] for side in sides) / reference.diagonal

    return ask


class Unseen(Mesh):
    """A mesh that equals itself alone: the library caches results of meshes and would find those of an equal one."""

    __eq__, __hash__ = object.__eq__, object.__hash__


def fresh(mesh, colors=None):
    """The same mesh, of which nothing is known yet."""
    return Unseen(mesh.vertices, mesh.faces, colors)


def speed_rows(name, mesh):
    """Time of Metro, the reference known and not, beside pymeshlab's, with and without the vertices among its samples.

    metro always measures the vertices, for max; `from arrays`: the meshes have to be handed over as well.
    """
    from haptic_glance.lod import metro

    rows = []
    for share in SHARES:
        small = coarser(mesh, share)
        calls = {
            "metro": lambda small=small, seed=0: metro(mesh, fresh(small), USUAL, seed)["mean"],
            "metro, first call": lambda small=small, seed=0: metro(fresh(mesh), fresh(small), USUAL, seed)["mean"],
            "pymeshlab": hausdorff(mesh, small, USUAL, False),
            "pymeshlab, with vertices": hausdorff(mesh, small, USUAL, True),
            "pymeshlab, with vertices, from arrays": lambda small=small: hausdorff(mesh, small, USUAL, True)(),
        }
        metro(mesh, small, USUAL)
        timings = {method: [timed(call) for _ in range(RUNS)] for method, call in calls.items()}
        peer = np.median([seconds for seconds, _ in timings["pymeshlab"]])
        seeds = [metro(mesh, small, USUAL, seed)["mean"] for seed in range(RUNS)]
        for method, runs in timings.items():
            seconds = float(np.median([spent for spent, _ in runs]))
            values = seeds if method.startswith("metro") else [value for _, value in runs]
            rows.append(
                {"what": "speed", "mesh": name, "faces": len(mesh.faces), "left": len(small.faces), "method": method,
                 "samples": USUAL, "metric": "metro_mean", "value": float(np.mean(values)), "sd": float(np.std(values)),
                 "seconds": seconds, "ratio": peer / seconds}
            )  # fmt: skip
    return rows


def sample_rows(name, mesh):
    """Relative error of the mean over the number of samples, ours and pymeshlab's, against 4 million of ours."""
    small, rows = coarser(mesh, 0.1), []
    truth = _mean_error(mesh, small, TRUTH, seed=99)
    for samples in SAMPLES:
        runs = RUNS if samples < 100_000 else 2
        theirs = hausdorff(mesh, small, samples, False)
        timings = {
            "metro": [timed(functools.partial(_mean_error, mesh, small, samples, seed)) for seed in range(runs)],
            "pymeshlab": [timed(theirs) for _ in range(runs)],
        }
        peer = np.median([seconds for seconds, _ in timings["pymeshlab"]])
        for method, pairs in timings.items():
            off = np.array([value for _, value in pairs]) / truth - 1
            seconds = float(np.median([seconds for seconds, _ in pairs]))
            rows.append(
                {"what": "samples", "mesh": name, "faces": len(mesh.faces), "left": len(small.faces), "method": method,
                 "samples": samples, "metric": "metro_mean", "value": float(np.sqrt((off**2).mean())),
                 "sd": float(off.std()), "seconds": seconds, "ratio": peer / seconds}
            )  # fmt: skip
    return rows


def _mean_error(reference, mesh, samples, seed):
    from haptic_glance.lod import metro

    return metro(reference, mesh, samples, seed)["mean"]


def view_rows(name, mesh):
    """Relative error of the picture errors over fewer views, against all 62; by chance, and for the named sets."""
    from haptic_glance.lod import picture_errors, take_pictures
    from haptic_glance.look.views import CANDIDATES, VIEWPOINTS

    small, rows = coarser(mesh, 0.1), []
    taken = [take_pictures(entry, CANDIDATES) for entry in (mesh, small)]
    per_view = (
        float(np.median([timed(lambda: take_pictures(fresh(small), VIEWPOINTS["twelve"]))[0] for _ in range(3)])) / 12
    )
    seconds, _ = timed(lambda: picture_errors(*taken))
    single = [picture_errors(*(entry[[k]] for entry in taken)) for k in range(len(CANDIDATES))]
    for metric in single[0]:
        values = np.array([entry[metric] for entry in single])
        sets = {"any": [(n, [rng(seed, f"{name} {n}").permutation(62)[:n] for seed in range(CHOICES)]) for n in VIEWS]}
        sets |= {set_: [(len(views), [_places(views, CANDIDATES)])] for set_, views in VIEWPOINTS.items()}
        for method, choices in sets.items():
            for n, chosen in choices:
                off = [_mean(values, picked, mesh, small, metric) / values.mean() - 1 for picked in chosen]
                rows.append(
                    {"what": "views", "mesh": name, "faces": len(mesh.faces), "left": len(small.faces),
                     "method": method, "views": n, "metric": metric, "value": float(np.sqrt(np.mean(np.square(off)))),
                     "sd": float(np.std(off)), "seconds": n * (per_view + seconds / len(CANDIDATES))}
                )  # fmt: skip
    return rows


def _places(views, candidates):
    """Places of the views among the candidates where they are all there, else the views themselves."""
    return [candidates.index(view) for view in views] if set(views) <= set(candidates) else views


def _mean(values, picked, mesh, small, metric):
    """The error over the views picked: by place, or pictures taken anew."""
    from haptic_glance.lod import perceptual
    from haptic_glance.look.views import Viewpoint

    if isinstance(picked[0], Viewpoint):
        return perceptual(mesh, small, picked)[metric]
    return values[list(picked)].mean()


def main():
    """Measures and writes the table."""
    arguments(__doc__)
    import cv2

    cv2.setNumThreads(1)
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    named, rows = meshes(), []
    for name, mesh in named.items():
        rows += speed_rows(name, mesh)
    for name in [name for name in ("duck", "Vase/361", "Armadillo/281") if name in named]:
        rows += sample_rows(name, named[name])
    for name, mesh in named.items():
        rows += view_rows(name, mesh)
    frame = pd.DataFrame(rows)
    write_table(OUT, frame)
    speed = frame[frame["what"] == "speed"]
    print(speed.groupby("method", sort=False)["ratio"].describe()[["min", "50%", "max"]].round(2).to_string())


if __name__ == "__main__":
    main()
