"""Checks on meshes with human gaze: the thesis's choice of viewpoints (T3.2.4), and how far choices flatter the glance.

Reads data/SET/meshes and data/SET/weights of objects with human gaze. Writes
reports/measurements/SET/attention_checks.csv.gz: NSS and AUC of equal weights from the most salient of 62 viewpoints,
from four and from twelve; and of the glance with features and ridge chosen once (glance_once), and chosen anew without
the object (glance_nested).

A model that leaves an object out of its fit may still have features and a ridge that were chosen by looking at it.
A nested fit chooses both anew for each object from all the others. That takes thousands of fits, so each of them is a
step of Newton's method from the fit with all features: there the likelihood of an object is a quadratic form, and a
choice that leaves an object out is one small linear system. The last fit, with the chosen features, is exact.
"""

import functools
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from haptic_glance.base.files import read_arrays, read_mesh
from haptic_glance.base.lazy import cv2
from haptic_glance.base.timing import Stopwatch
from haptic_glance.look.agreement import GroundTruth, auc, nss
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels import CHANNELS
from haptic_glance.look.points import best_viewpoints, compute_maps
from haptic_glance.look.points.glance import GlanceDetector
from haptic_glance.look.points.options import Options
from haptic_glance.look.views import FOUR, TWELVE
from haptic_glance.look.weights import LearnedWeights, fit_fixations
from haptic_glance.look.weights.attention import RIDGE
from haptic_glance.look.weights.weights import GLANCE, GLANCES
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import named_means
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments

from . import COLUMNS, Params

RIDGES = (0.0003, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3)
FIXED = tuple(GLANCES[GLANCE])  # the features by the choice that was made once, on all objects


class Seen(NamedTuple):
    """One object for the fit of the glance: features {name: (n,)} of samples, amounts of gaze and areas (n,)."""

    features: dict[str, np.ndarray]
    amounts: np.ndarray
    areas: np.ndarray

    def stacked(self, names: tuple[str, ...]) -> np.ndarray:
        """(n, len(names)) of these features."""
        return np.stack([self.features[name] for name in names], axis=1)


def process_nested(method: str, folder: Path, data: Path, names: list[str]) -> Rows:
    """Rows for each object, left out: with the features and ridge chosen once, and chosen without it.

    The methods are METHOD_once and METHOD_nested; metrics nss and auc, the number of `features` and the `ridge`; the
    column chosen names the features.
    """
    gaze = {name: read_arrays(data / "weights/ground_truth" / f"{name}.npz") for name in names}
    seen_entries = {name: _seen(entry) for name, entry in gaze.items()}
    rows = []
    for name, arrays in gaze.items():
        other_entries = {other: entry for other, entry in seen_entries.items() if other != name}
        truth = GroundTruth(arrays["amounts"], arrays["density"], arrays["areas"])
        fit = functools.cache(functools.partial(_fit, other_entries))  # the fixed choice may be all features
        nested_choice = choose(other_entries, fit(tuple(seen_entries[name].features), RIDGE))
        for way, (features, ridge) in {"once": (FIXED, RIDGE), "nested": nested_choice}.items():
            weights = dict(zip(features, fit(features, ridge).tolist(), strict=True))
            saliency = _saliency(data / "meshes" / f"{name}.npz", weights)
            values = {metric.__name__: float(metric(saliency, truth)) for metric in (nss, auc)}
            values |= {"features": len(features), "ridge": ridge}
            common = {"item": name, "method": f"{method}_{way}", "chosen": ", ".join(features)}
            rows += [common | {"metric": metric, "value": value} for metric, value in values.items()]
    return rows


def choose(objects: Mapping[str, Seen], around: np.ndarray) -> tuple[tuple[str, ...], float]:
    """(features, ridge) under which gaze on an object that is left out is the most likely, on average over the objects.

    around: the weights of all features, fitted to all these objects. Features are added one at a time, the best first;
    of all numbers of features the best is taken.
    """
    names = tuple(next(iter(objects.values())).features)
    slopes, bends = _quadratic(objects, names, around)
    ids, steps = [], []
    for _ in names:
        candidates = [(*_left_out(slopes, bends, [*ids, k]), k) for k in range(len(names)) if k not in ids]
        loss, ridge, best = min(candidates)
        ids.append(best)
        steps.append((loss, len(ids), ridge))
    _, count, ridge = min(steps)
    return tuple(names[k] for k in sorted(ids[:count])), ridge


def _quadratic(
    objects: Mapping[str, Seen], names: tuple[str, ...], around: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(slopes (k, d), bends (k, d, d)): near the weights `around` the loss of object k is slopes w + w bends w / 2."""
    slopes, bends = [], []
    for item in objects.values():
        features = item.stacked(names).astype(np.float64)
        score = features @ around + np.log(np.maximum(item.areas, 1e-300))
        likely = np.exp(score - np.logaddexp.reduce(score))
        mean = likely @ features
        bends.append(features.T @ (likely[:, None] * features) - np.outer(mean, mean))
        slopes.append(mean - item.amounts / item.amounts.sum() @ features - bends[-1] @ around)
    return np.stack(slopes), np.stack(bends)


def _left_out(slopes: np.ndarray, bends: np.ndarray, chosen: list[int]) -> tuple[float, float]:
    """(mean loss of an object that is left out, ridge): of the best ridge, with some of the features."""
    slopes, bends = slopes[:, chosen], bends[:, chosen][:, :, chosen]
    count = len(slopes) - 1
    slope, bend = (slopes.sum(axis=0) - slopes) / count, (bends.sum(axis=0) - bends) / count
    losses = []
    for ridge in RIDGES:
        weights = np.linalg.solve(bend + 2 * ridge * np.eye(len(chosen)), -slope[..., None])[..., 0]
        values = np.einsum("ki,ki->k", slopes, weights) + np.einsum("ki,kij,kj->k", weights, bends, weights) / 2
        losses.append((float(values.mean()), ridge))
    return min(losses)


def _fit(objects: Mapping[str, Seen], names: tuple[str, ...], ridge: float) -> np.ndarray:
    parts = [(item.stacked(names), item.amounts, item.areas) for item in objects.values()]
    features, amounts, areas = zip(*parts, strict=True)
    return fit_fixations(features, amounts, areas, ridge)


def _seen(gaze: dict[str, np.ndarray]) -> Seen:
    features = dict(zip(map(str, gaze["glance_names"]), gaze["glance"].T, strict=True))
    return Seen(features, gaze["glance_amounts"], gaze["glance_areas"])


def _saliency(path: Path, weights: dict[str, float]) -> np.ndarray:
    return GlanceDetector(GLANCE).saliency(read_mesh(path), None, Options(LearnedWeights({GLANCE: weights})))


VIEWS: dict[str, Callable[[Mesh], Sequence[Viewpoint]]] = {
    "best": best_viewpoints,
    "four": lambda _: FOUR,
    "twelve": lambda _: TWELVE,
}


def process_views(name: str, folder: Path, data: Path, views: Sequence[str]) -> Rows:
    """Rows of NSS and AUC of one object: the plain average of all nine channels, from each set of viewpoints."""
    cv2.setNumThreads(1)  # a worker is one core, and `seconds` are of one core
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    gaze = read_arrays(data / "weights/ground_truth" / f"{name}.npz")
    truth = GroundTruth(gaze["amounts"], gaze["density"], gaze["areas"])
    rows = []
    for view_set in views:
        viewpoints = VIEWS[view_set](mesh)
        with Stopwatch() as watch:
            maps = compute_maps(mesh, CHANNELS, viewpoints, "raster")
            assert maps is not None  # there are channels
            saliency = np.add.reduce([maps.vertex_values(maps.maps[channel]) for channel in CHANNELS])
        rows += [
            {"item": name, "views": view_set, "method": "equal", "metric": metric.__name__, "seconds": watch.seconds}
            | {"value": float(metric(saliency, truth))}
            for metric in (nss, auc)
        ]
    return rows


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    views = list(workspace.settings(Params).views)
    with StageRun(workspace, "attention_checks", COLUMNS, inputs=("meshes", "weights")) as stage:
        names = sorted(path.stem for path in (workspace.data / "weights/ground_truth").glob("*.npz"))
        if len(names) < 2:
            raise ValueError(f"{workspace.dataset} has {len(names)} objects with ground truth; two are needed")
        work = functools.partial(process_views, data=workspace.data, views=views)
        stage.each(work, names, ["meshes/{}.npz", "weights/ground_truth/{}.npz"])
        work = functools.partial(process_nested, data=workspace.data, names=names)
        stage.each(work, [GLANCE], ["meshes", "weights/ground_truth"])
        stage.metrics(summary(stage.rows))
    print(f"attention_checks: {workspace.dataset}, {len(names)} objects, viewpoints {', '.join(views)}")


def summary(rows: Rows) -> dict[str, float]:
    """{METHOD, or METHOD.VIEWS: its mean NSS}."""
    return named_means(
        (".".join([row["method"], *filter(None, [row.get("views")])]), row["value"])
        for row in rows
        if row["metric"] == "nss"
    )


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "attention_checks"))
