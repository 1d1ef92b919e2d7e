"""The agreement of maps with people (T3.3.6), its summary for the gate, and control saliencies.

Any model must beat the controls: the centre of the image, and random values. Also measured is how concentrated a
saliency is: the thesis's deep maps are one or two regions, its classical ones broad (T3.4).
"""

import itertools
from collections.abc import Mapping, Sequence
from typing import cast

import numpy as np
import pandas as pd

from haptic_glance.look.agreement import GroundTruth, auc, cc, nss
from haptic_glance.mesh.mesh import Mesh
from stages.engine.statistics import interval

from .places import centre_distance

ALL_VIEWS = "all"  # all views together


def agreement_rows(
    mesh: Mesh,
    fixations: Mapping[str, np.ndarray],
    visible: np.ndarray,
    by_view: np.ndarray,
    whole: np.ndarray,
    distances: bool = True,
) -> list[dict]:
    """Rows of view, metric and value: one saliency compared with human fixations.

    fixations: arrays of stages.weights.training; visible (3, n) boolean and by_view (3, n): the evaluated views
    and the saliency in each; whole (n,): the saliency over all views, used for nss and auc. pcc in a view weights each
    visible vertex by its area. pcc_masked is the thesis's number: over all vertices, with both maps scaled to 0..1 and
    the hidden vertices set to zero, so that visibility alone gives some correlation. distances: adds the distance
    between fixation centres in each view (T figure 3.36): the least in units, the mean over the pairs (distance_mean),
    and that of the maxima to the letter (distance_maximum); and how concentrated the saliency is: half_share of what
    the view sees.
    """
    rows = []
    for view, (mask, values) in enumerate(zip(visible, by_view, strict=True)):
        truth = visible_truth(fixations, mask)
        if truth is None:
            continue
        measures = {
            "pcc": cc(values[mask], truth),
            "pcc_masked": pearson(min_max_scaled(values) * mask, min_max_scaled(fixations["density"]) * mask),
        }
        if distances:
            least, mean = centre_distance(mesh.vertices, fixations["density"], values, mask)
            measures |= {"distance": least, "distance_mean": mean}
            measures["distance_maximum"] = centre_distance(mesh.vertices, fixations["density"], values, mask, top=1)[0]
            measures["half_share"] = half_share(values[mask], fixations["areas"][mask])
        cells = {metric: value if np.isfinite(value) else None for metric, value in measures.items()}
        rows += [{"view": view, "metric": metric, "value": value} for metric, value in cells.items()]
    truth = GroundTruth(fixations["amounts"], fixations["density"], fixations["areas"])
    return rows + [
        {"view": ALL_VIEWS, "metric": metric, "value": function(whole, truth)}
        for metric, function in (("pcc", cc), ("nss", nss), ("auc", auc))
    ]


def visible_truth(fixations: Mapping[str, np.ndarray], visible: np.ndarray) -> GroundTruth | None:
    """The GroundTruth of the vertices visible in a view, None where it has no fixations."""
    amounts, density, areas = (fixations[key][visible] for key in ("amounts", "density", "areas"))
    return GroundTruth(amounts, density, areas) if amounts.any() and (density * areas).any() else None


def min_max_scaled(values: np.ndarray) -> np.ndarray:
    """Values (n,) scaled to 0..1; zero where all are equal."""
    low, high = values.min(), values.max()
    return (values - low) / (high - low) if high > low else np.zeros_like(values)


def pearson(first: np.ndarray, second: np.ndarray) -> float:
    """Pearson's correlation of two arrays (n,); NaN where one is constant."""
    first, second = first - first.mean(), second - second.mean()
    size = np.sqrt((first @ first) * (second @ second))
    return float(first @ second / size) if size > 0 else np.nan


def task_correlations(values: np.ndarray, seen: np.ndarray, names: Sequence[str]) -> list[dict]:
    """Rows of the correlation between the maps of each two tasks, the mean over the views (T figure 3.31).

    values (v, t, n), seen (v, n); over the vertices visible in a view. Views where one of the maps is constant are left
    out.
    """
    matrices = np.full((len(values), len(names), len(names)), np.nan)
    for view, visible in enumerate(seen):
        part = values[view][:, visible]
        varied = np.flatnonzero(np.ptp(part, axis=1) > 0) if visible.any() else []
        if len(varied) > 1:
            matrices[view][np.ix_(varied, varied)] = np.corrcoef(part[varied])
    rows = []
    for i, j in itertools.combinations(range(len(names)), 2):
        finite = matrices[:, i, j][np.isfinite(matrices[:, i, j])]
        value = float(finite.mean()) if len(finite) else None
        rows.append({"task": f"{names[i]}~{names[j]}", "view": ALL_VIEWS, "metric": "pcc_tasks", "value": value})
    return rows


MODEL = "ewigc"
COLUMNS = ["item", "method", "task", "view", "split", "metric", "value"]


def summary(rows: Sequence[dict], classes: Mapping[str, int], seed: int) -> dict[str, dict]:
    """dict for the metric file: classes and mean accuracy of each task, mean agreement of the fused model and controls.

    classes: dict task -> number of classes. Agreement: the Pearson correlation in the three views, averaged per object,
    with its interval over the objects.
    """
    frame = pd.DataFrame(rows).reindex(columns=COLUMNS)
    tree: dict[str, dict] = {"classes": {task: int(count) for task, count in classes.items()}}
    accuracies = frame.loc[(frame["metric"] == "accuracy") & frame["value"].notna()]
    for key, part in accuracies.groupby(["method", "split"]):
        method, split = cast(tuple[str, str], key)
        tree.setdefault("accuracy", {}).setdefault(method, {})[split] = round(float(np.mean(part["value"])), 6)
    for name, values in agreement(frame).items():
        mean, low, high = np.round(interval(values, seed=seed), 6).tolist()
        ends = {"low": low, "high": high} if np.isfinite(low) else {}
        tree.setdefault("pcc", {})[name] = {"value": mean} | ends
    return tree


def agreement(frame: pd.DataFrame) -> dict[str, pd.Series]:
    """dict method -> Series object -> mean pcc over the views, of the fused models, rivals and controls."""
    views = frame.loc[(frame["metric"] == "pcc") & (frame["view"] != ALL_VIEWS)]
    selected = views.loc[(views["task"] == MODEL) | views["method"].isin(["control", "rival"])]
    means = {}
    for key, part in selected.groupby(["method", "task"], sort=True):
        method, task = cast(tuple[str, str], key)
        means[task if method in ("control", "rival") else method] = part.groupby("item")["value"].mean()
    return means


def half_share(values: np.ndarray, areas: np.ndarray) -> float:
    """The least share of a surface that holds half of a saliency: 0.5 where it is even, near 0 for one small place.

    values (n,) at the vertices, which weigh by their areas (n,) and count from the least on, since a saliency has no
    zero of its own. NaN where the values are constant.
    """
    values, areas = np.asarray(values, dtype=np.float64), np.asarray(areas, dtype=np.float64)
    above = values - values.min(initial=np.inf)
    if not (above * areas).any():
        return np.nan
    order = np.argsort(-above, kind="stable")
    saliency_sums, area_sums = np.cumsum((above * areas)[order]), np.cumsum(areas[order])
    return float(np.interp(0.5, saliency_sums / saliency_sums[-1], area_sums / area_sums[-1]))


SPREAD = 0.25  # of the image's side: deviation of the Gaussian; half of the object lies within it


def centre_prior(size: int) -> np.ndarray:
    """(size, size) f8 in 0..1: a Gaussian at the centre of the image."""
    across = np.exp(-(((np.arange(size) - (size - 1) / 2) / (SPREAD * size)) ** 2) / 2)
    return across[:, None] * across
