"""Learns the method glance_deep from human gaze and judges it on unseen objects: `python -m benchmarks.deep_gaze`.

The objects of both sets with gaze, 19 meshes and 14 point clouds, are left out one at a time, and the model is learned
from the 32 others. So are its rivals: the glance, and a model of three simple features, the height, how much a place
faces viewers from the side, and the distance to the middle, which any learned model must beat. A random half of the
fixated vertices of each object predicts the other half, to tell how much of the gaze is within reach at all. Prints the
means, the paired differences with a 95 % interval over objects, and the weights learned from all objects, which are
published (haptic_glance.look.weights.weights). Writes reports/bench/deep_gaze.csv: set, item, method, metric, value,
seconds (of the processor, for the saliency of an object, without the training), and deep_gaze_means.csv with the means
and differences. About 15 minutes on one core.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from benchmarks import arguments
from haptic_glance.base.files import write_table
from haptic_glance.base.timing import Stopwatch
from haptic_glance.look.agreement import GroundTruth, auc, cc, kl, nss
from haptic_glance.look.glance import Samples, samples_of_mesh
from haptic_glance.look.glance.cells import visibility
from haptic_glance.look.points.glance import GlanceDetector, cell_features, deep_features
from haptic_glance.look.points.options import Options
from haptic_glance.look.weights import LearnedWeights
from haptic_glance.look.weights.attention import RIDGE, standardise
from haptic_glance.look.weights.weights import MAPS
from haptic_glance.mesh.mesh import Mesh
from stages.bench import gazed
from stages.engine.parallel import progress
from stages.engine.statistics import interval
from stages.weights.ground_truth import spread_on_surface
from stages.weights.training import SPREAD

OUT, SHARED = Path("reports/bench/deep_gaze.csv"), Path("../shared/data")
SETS, METRICS = ("gaze", "gaze_clouds"), (nss, auc, cc, kl)
MAPS_RIDGE = 1.0  # penalty on the squared weights of the maps: they are many
STEPS, CLOSE = 30, 1e-5  # of Newton's method, and the change of a weight below which it ends
LIMIT = 4.0  # standard deviations, as of the features of the glance
HALF, DRAWS = "half_of_gaze", 3  # the name of gaze that predicts gaze, and the random halves of each object


class Gaze(NamedTuple):
    """The training data of one object: features (s, d) f4, shares of the gaze (s,) and areas (s,)."""

    features: np.ndarray
    shares: np.ndarray
    areas: np.ndarray


def simple_features(mesh: Mesh, samples: Samples) -> dict[str, np.ndarray]:
    """dict name -> (s,) f8: standardised height, facing and distance."""
    features = {
        "height": samples.points[:, 2],
        "facing": visibility(samples)[1],
        "distance": np.linalg.norm(samples.local, axis=1),
    }
    return {name: standardise(values, samples.areas).clip(-LIMIT, LIMIT) for name, values in features.items()}


FEATURES = {"glance": cell_features, "glance_deep": deep_features, "simple": simple_features}


def density(gaze: Gaze, weights: np.ndarray) -> np.ndarray:
    """(s,) f8 the probability of a fixation, see haptic_glance.look.weights.fit_fixations, at the weights (d,)."""
    score = gaze.features @ weights.astype(np.float32) + np.log(np.maximum(gaze.areas, 1e-300))
    return np.exp(score - np.logaddexp.reduce(score))


def slope(gaze: Gaze, weights: np.ndarray) -> np.ndarray:
    """(d,) the first derivative of the loss of an object at the weights (d,)."""
    return (density(gaze, weights) - gaze.shares).astype(np.float32) @ gaze.features


def bend(gaze: Gaze, weights: np.ndarray) -> np.ndarray:
    """(d, d) the second derivative of the loss of an object at the weights (d,)."""
    likely = density(gaze, weights).astype(np.float32)
    mean = likely @ gaze.features
    return (gaze.features.T * likely) @ gaze.features - np.outer(mean, mean)


def fitted(objects: Iterable[Gaze], ridge: np.ndarray, start: np.ndarray, near: np.ndarray | None = None) -> np.ndarray:
    """(d,) the weights of haptic_glance.look.weights.fit_fixations with a penalty (d,) for each weight, by Newton's
    method.

    near (d, d): the mean bend at weights close to the optimum, used in every step; None computes the bend at each step.
    """
    weights, objects = start, list(objects)
    for _ in range(STEPS):
        bends = np.mean([bend(gaze, weights) for gaze in objects], axis=0) if near is None else near
        slopes = np.mean([slope(gaze, weights) for gaze in objects], axis=0)
        step = np.linalg.solve(bends + np.diag(2 * ridge), slopes + 2 * ridge * weights)
        weights = weights - step * min(1.0, 1 / np.abs(step).max())  # the first steps are long
        if np.abs(step).max() < CLOSE:
            break
    return weights


def left_out(method: str, objects: Mapping[tuple[str, str], Gaze], names: list[str]) -> dict[tuple[str, str], dict]:
    """{object: {feature: weight}} learned from the others; that of ("", "") from all."""
    ridge = np.where(np.isin(names, MAPS), MAPS_RIDGE, RIDGE)
    everything = fitted(objects.values(), ridge, np.zeros(len(names)))
    bends = np.stack([bend(gaze, everything) for gaze in objects.values()])
    learned = {("", ""): everything}
    for k, item in enumerate(progress(objects, method)):
        others = [gaze for other, gaze in objects.items() if other != item]
        learned[item] = fitted(others, ridge, everything, np.delete(bends, k, axis=0).mean(axis=0))
    return {item: dict(zip(names, weights.tolist(), strict=True)) for item, weights in learned.items()}


def features_of(method: str, objects: Mapping) -> tuple[dict[tuple[str, str], Gaze], list[str]]:
    """({object: its Gaze}, names of the features) of objects {(set, name): (mesh, GroundTruth)}."""
    seen, names = {}, []
    for item, (mesh, truth) in progress(objects.items(), f"features of {method}"):
        samples = samples_of_mesh(mesh)
        features = FEATURES[method](mesh, samples)
        names, gaze = (
            list(features),
            np.bincount(samples.tree.query(mesh.vertices)[1], truth.amounts, len(samples.areas)),
        )
        seen[item] = Gaze(np.stack([*features.values()], axis=1).astype(np.float32), gaze / gaze.sum(), samples.areas)
    return seen, names


def rows_of(method: str, objects: Mapping) -> tuple[list[dict], dict[str, float]]:
    """(rows of METRICS of the objects, each left out; the weights learned from all)."""
    weights, rows = left_out(method, *features_of(method, objects)), []
    detector = GlanceDetector(method, FEATURES[method])
    for item, (mesh, truth) in progress(objects.items(), f"saliency of {method}"):
        with Stopwatch() as watch:
            saliency = detector.saliency(mesh, None, Options(LearnedWeights({method: weights[item]})))
        row = {"set": item[0], "item": item[1], "method": method}
        rows += [
            row | {"metric": metric.__name__, "value": metric(saliency, truth), "seconds": watch.seconds}
            for metric in METRICS
        ]
    return rows, weights["", ""]


def rows_of_halves(objects: Mapping) -> list[dict]:
    """Rows of METRICS of each object: the mean over DRAWS random halves, each of which predicts the other half."""
    rows = []
    for item, (mesh, truth) in progress(objects.items(), HALF):
        rng, values = np.random.default_rng(0), []
        for _ in range(DRAWS):
            first = rng.random(len(truth.amounts)) < 0.5
            parts = [np.where(first, truth.amounts, 0), np.where(first, 0, truth.amounts)]
            maps = [spread_on_surface(mesh, amounts, SPREAD * mesh.diagonal) for amounts in parts]
            for k in (0, 1):
                other = GroundTruth(parts[1 - k], maps[1 - k], truth.areas)
                values.append([metric(maps[k], other) for metric in METRICS])
        means = zip(METRICS, np.mean(values, axis=0), strict=True)
        row = {"set": item[0], "item": item[1], "method": HALF}
        rows += [row | {"metric": metric.__name__, "value": value} for metric, value in means]
    return rows


def summary(table: pd.DataFrame, method: str, than: str) -> pd.DataFrame:
    """By set and metric: means and median seconds of both methods, and the interval of their paired difference."""
    seconds = table.groupby("method")["seconds"].median()
    wide = table.pivot(index=["set", "item", "metric"], columns="method", values="value").reset_index()
    pooled = pd.concat([wide, wide.assign(set="both")])
    rows = []
    for (name, metric), group in pooled.groupby(["set", "metric"]):
        mean, low, high = interval(group[method] - group[than])
        means = {"mean": group[method].mean(), "seconds": seconds[method], "than_mean": group[than].mean()}
        means |= {"than_seconds": seconds[than], "difference": mean, "low": low, "high": high}
        rows.append({"method": method, "than": than, "set": name, "metric": metric, "objects": len(group)} | means)
    return pd.DataFrame(rows).round(3)


def main():
    arguments(__doc__)
    objects = {(name, item): part for name in SETS for item, part in gazed(name, SHARED / f"{name}.zip").items()}
    rows = []
    for method in FEATURES:
        part, weights = rows_of(method, objects)
        rows += part
        print(method, {name: round(weight, 3) for name, weight in weights.items()})
    table = pd.DataFrame([*rows, *rows_of_halves(objects)])
    write_table(OUT, table.round({"value": 6, "seconds": 3}))
    pairs = [("glance_deep", "glance"), ("glance", "simple"), ("glance_deep", "simple")]
    pairs += [(HALF, "glance_deep"), (HALF, "glance")]
    means = pd.concat([summary(table, *pair) for pair in pairs])
    write_table(OUT.with_name("deep_gaze_means.csv"), means)
    print(means.to_string(index=False))


if __name__ == "__main__":
    main()
