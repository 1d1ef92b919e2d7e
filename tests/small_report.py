"""A small run to report on: measurements with a known truth, beside the thesis's tables."""

from pathlib import Path

import numpy as np
import pandas as pd

from haptic_glance.base.files import write_arrays, write_mesh, write_table, write_text
from haptic_glance.look.channels import CHANNELS
from haptic_glance.look.weights.svm import fit_svm
from haptic_glance.look.weights.weights import write_models
from haptic_glance.mesh.mesh import Mesh
from stages.charts.results import Results
from stages.engine.settings import Workspace
from stages.report import Params

THESIS = Path(__file__).parents[1] / "data/reference/thesis"
SETS = ("test", "household", "furniture")  # switched on in the small run
OBJECTS = ["ball", "cube"]
METHODS = ["glance", "itti", "VisAttAll", "guided_ssim", "height"]  # methods with points and saliency


def settings(**changes):
    """The report's settings for the small run."""
    values = {
        "hero_object": "ball", "figure_objects": ["ball"], "viewer_objects": ["ball"], "viewer_count": 2,
        "viewer_faces": 10000, "viewer_lod_methods": ["qem", "glance"], "viewer_kilobytes": 1000,
    }  # fmt: skip
    return Params(**values | changes)


def ball(rings=12):
    """A closed ball of radius 0.5."""
    polar, around = np.meshgrid(
        np.linspace(0, np.pi, rings + 1)[1:-1], np.arange(2 * rings) * np.pi / rings, indexing="ij"
    )
    rows = np.stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)], -1).reshape(-1, 3)
    vertices = 0.5 * np.vstack([rows, [0, 0, 1], [0, 0, -1]])
    grid = np.arange(len(rows)).reshape(rings - 1, 2 * rings)
    a, b, c, d = grid[:-1], np.roll(grid, -1, 1)[:-1], grid[1:], np.roll(grid, -1, 1)[1:]
    sides = np.concatenate([np.stack([a, c, b], -1).reshape(-1, 3), np.stack([b, c, d], -1).reshape(-1, 3)])
    top = np.stack([grid[0], np.roll(grid[0], -1), np.full(2 * rings, len(rows))], -1)
    bottom = np.stack([np.roll(grid[-1], -1), grid[-1], np.full(2 * rings, len(rows) + 1)], -1)
    return Mesh(vertices, np.concatenate([sides, top, bottom]))


def classification(thesis=0.8, rivals=0.5):
    """Rows with known accuracies: the thesis's model, and ours, are better by a margin far over the noise."""
    rng = np.random.default_rng(0)
    rows = []
    for objects in ("six", "four"):
        for method, accuracy in (("thesis_ssim", thesis), ("glance", thesis), ("itti", rivals), ("random", rivals)):
            for classifier, seconds in (("knn", 0.01), ("deep_learning", 1.0)):
                for repetition in range(6):
                    value = accuracy + 0.01 * rng.normal()
                    row = {"dataset": "test", "group": objects, "method": method, "variant": "plain"}
                    row |= {"classifier": classifier, "repetition": repetition, "split": "random", "metric": "accuracy"}
                    row |= {"value": value, "scaling": "training"}
                    rows.append(row | {"seconds": seconds, "seed": 0})
    return pd.DataFrame(rows)


def lod():
    """Rows in which plain QEM has exactly half the error of the thesis's model and of ours; a cell is infeasible."""
    rows = []
    for name in OBJECTS:
        for method, factor in (("qem", 1.0), ("thesis_ssim", 2.0), ("glance", 2.0)):
            for target, error in (("50%", 0.01), ("25%", 0.03)):
                infeasible = (name, target) == ("cube", "25%") and method != "qem"
                cell = {"dataset": "test", "item": name, "method": method, "target": target, "faces": 100}
                cell |= {"points": 0 if method == "qem" else 3, "shrunk": False}
                values = {"faces": 100, "metro_mean": error * factor, "ssim_error": error * factor}
                for metric, value in values.items():
                    value = np.nan if infeasible else value
                    rows.append(cell | {"metric": metric, "value": value, "seconds": 0.1, "seed": 0})
    return pd.DataFrame(rows)


def read_results(root, **changes):
    """The results of a small run below a root."""
    return Results(Workspace(root), settings(**changes))


def write_measurements(root, stage, frame, dataset=None):
    """Puts a frame where the report reads it: on the sets of its column, or on one."""
    frame = frame.assign(dataset=dataset) if dataset else frame
    for name, part in frame.groupby("dataset", sort=False):
        write_table(root / f"reports/measurements/{name}/{stage}.csv.gz", part)


def write_set(root, name, count):
    """Leaves behind what the classification does of a group of so many objects."""
    write_arrays(
        root / "data/test/classification" / f"{name}.glance.npz", objects=np.array([f"o{k}" for k in range(count)])
    )


def left_out(frame, note, **where):
    """The frame without the rows of `where`; in their place one row with the reason and no more."""
    mask = np.logical_and.reduce([frame[column] == value for column, value in where.items()])
    row = {"dataset": "test", **where, "value": np.nan, "note": note, "seed": 0}
    return pd.concat([frame[~mask], pd.DataFrame([row])], ignore_index=True)


def own_results(root, folder="meshes"):
    """The results of a root whose first set is a folder of a person's own meshes."""
    more = f"test: {{meshes: {{source: folder, folder: {folder}}}}}\n"
    write_text(root / "params.yaml", (root / "params.yaml").read_text() + more)
    return read_results(root)


def judged(offsets=None):
    """Rows of agreement with a known truth: each mesh adds its own level to every method, and a little noise."""
    means = {
        "glance": 1.5, "itti": 0.2, "VisAtt": 0.2, "VisAttAll": 0.2, "equal": 0.3, "guided_ssim": 0.1,
        "guided_ed": 0.5, "thesis_ssim": 0.3, "facing_viewer": 0.7, "svm+object": 0.9, "human": 2.0,
    }  # fmt: skip
    random, rows = np.random.default_rng(0), []
    for name, level in zip("abcdef", np.linspace(-0.5, 0.5, 6), strict=True):
        for method, mean in (means | (offsets or {})).items():
            nss = mean + level + 0.01 * random.normal()
            values = {"nss": nss, "auc": 0.5 + nss / 10, "cc": 0.3, "sim": 0.5, "kl": 1.0}
            if method != "human":
                values |= {"points_strong": 20, "fne@0.05": 0.4, "fpe@0.05": 0.6, "wme@0.05": 0.5}
            cell = {"dataset": "gaze", "item": name, "method": method, "seconds": 0.5, "seed": 0}
            rows += [cell | {"metric": metric, "value": value} for metric, value in values.items()]
    return pd.DataFrame(rows)


def learned_weights(count=6, **more):
    """A table of learned weights, and the values of each object that they are the means of: (frame, (count, 9)).

    more: what is added to the values of a channel.
    """
    values, rows = np.random.default_rng(1).random((count, len(CHANNELS))), []
    for channel, value in more.items():
        values[:, list(CHANNELS).index(channel)] += value
    for method in ("guided_ssim", "guided_ed", "guided_ssim+object"):
        for fold in range(-1, count):
            mean = np.delete(values, fold, axis=0).mean(axis=0) if fold >= 0 else values.mean(axis=0)
            left_out = "abcdef"[fold] if fold >= 0 else ""
            rows += [(method, channel, value, left_out) for channel, value in zip(CHANNELS, mean, strict=True)]
    rows += [("glance", "rank", 0.3, fold) for fold in ("", *"abcdef"[:count])]
    return pd.DataFrame(rows, columns=["method", "channel", "weight", "left_out"]), values


def svm_accuracies():
    """Rows of the SVMs: an object's own is right by 4 points more often than the one for all."""
    ways = [("one_for_all", "pixels", 0.86), ("one_per_object", "pixels", 0.9), ("one_per_object", "views", 0.88)]
    rows = []
    for area in ("image", "object"):
        for training, validation, mean in ways:
            names = [None] if training == "one_for_all" else list("abcdef")
            for k, name in enumerate(names):
                row = {"item": name, "method": "svm", "area": area, "training": training, "validation": validation}
                row |= {"deviation": 0.03, "background_alone": 0.85, "metric": "accuracy"}
                rows.append(row | {"value": mean + 0.001 * (k - (len(names) - 1) / 2), "seconds": None})
    return pd.DataFrame(rows)


def views_seen():
    """Rows of two objects; the greedy choice sees all of the second with one view less."""
    shares = {("ball", "greedy"): [0.5, 0.9, 1.0], ("cube", "greedy"): [0.6, 1.0], ("ball", "four"): [0.3, 0.5]}
    rows = [
        {"item": name, "method": method, "metric": "seen_share", "views": k, "value": share, "seconds": 7.0}
        for (name, method), curve in shares.items()
        for k, share in enumerate(curve, start=1)
    ]
    rows += [{"item": name, "method": "exact", "metric": "fewest_views", "value": 3} for name in OBJECTS]
    rows += [{"item": name, "method": "raster", "metric": "coverage", "value": 0.5, "seconds": 1.0} for name in OBJECTS]
    return pd.DataFrame(rows).assign(dataset="test")


def write_attention(root):
    """Adds to a root what the pieces on attention read: measured on gaze, and of this run's own objects."""
    table, _ = learned_weights()
    seconds = [{"item": "a", "method": name, "metric": "silhouette_share", "value": 1.0, "seconds": 1.0}
               for name in CHANNELS]  # fmt: skip
    weights = table.rename(columns={"weight": "value", "left_out": "item"}).assign(metric="weight")
    frames = {
        "salient_points": judged(), "weights": pd.concat([svm_accuracies(), weights]),
        "conspicuity": pd.DataFrame(seconds),
        "views": pd.DataFrame([{"item": "a", "method": "raster", "metric": "coverage", "value": 0.5, "seconds": 2.0}]),
    }  # fmt: skip
    for stage, frame in frames.items():
        write_measurements(root, stage, frame, "gaze")
    write_measurements(root, "salient_points", judged(), "household")
    write_measurements(root, "weights", svm_accuracies(), "test")
    write_measurements(root, "views", views_seen())
    write_table(root / "data/test/weights/weights.csv", table)
    write_table(root / "data/test/weights/convexity.csv", pd.DataFrame({"object": OBJECTS, "convexity": [0.9, 0.8]}))
    for name in OBJECTS:
        _write_maps(root, name)


def _write_maps(root, name):
    """Maps, ground truth, SVMs and the points of several methods, for a ball."""
    mesh, shape, random = ball(), (60, 80), np.random.default_rng(3)
    mask = np.hypot(*(np.mgrid[:60, :80] - np.array([29.5, 39.5])[:, None, None])) < 28
    maps = random.random((2, len(CHANNELS), *shape)).astype(np.float16) * mask
    views = ["az0_el0", "az90_el0"]
    write_arrays(
        root / f"data/test/conspicuity/{name}.npz", maps=maps, mask=np.stack([mask] * 2), viewpoints=views,
        channels=list(CHANNELS),
    )  # fmt: skip
    truth = {"density": np.linspace(0, 1, len(mesh.vertices)), "points": np.arange(0, 200, 20)}
    write_arrays(root / f"data/test/weights/ground_truth/{name}.npz", **truth, channels=list(CHANNELS))
    rows = random.random((200, len(CHANNELS)))
    model = fit_svm(rows, rows[:, 0] > 0.5, seed=0)
    write_models(root / f"data/test/weights/svm/{name}.npz", {"object": [model], "without": [model]})
    detection = {
        "points": np.array([3, 50, 100]),
        "strong": np.int64(2),
        "saliency": np.linspace(0, 1, len(mesh.vertices)),
    }
    arrays = {f"{method}.{key}": values for method in METHODS for key, values in detection.items()}
    write_arrays(root / f"data/test/salient_points/{name}.npz", **arrays)


def make_bare(root):
    """A root with the thesis's tables and nothing measured."""
    (root / "data/reference").mkdir(parents=True)
    (root / "data/reference/thesis").symlink_to(THESIS)
    common = f"seed: 0\nprofile: test\nparallel: {{backend: sequential}}\ngraph: {{}}\nsets: [{', '.join(SETS)}]\n"
    write_text(root / "params.yaml", common)
    return root


def make_root(root):
    """A root with two objects and a few measurements."""
    make_bare(root)
    mesh = ball()
    for name in OBJECTS:
        write_mesh(root / "data/test/meshes" / f"{name}.npz", mesh)
        points = np.array([3, 50, 100])
        detection = {"points": points, "strong": np.int64(2), "saliency": np.linspace(0, 1, len(mesh.vertices))}
        arrays = {f"glance.{key}": value for key, value in detection.items()}
        write_arrays(root / "data/test/salient_points" / f"{name}.npz", **arrays)
        write_mesh(root / "data/test/lod" / name / "qem_50pct.npz", ball(8))
    write_measurements(root, "classification", classification())
    write_set(root, "six", 6)
    write_set(root, "four", 4)
    write_measurements(root, "lod", lod())
    return root
