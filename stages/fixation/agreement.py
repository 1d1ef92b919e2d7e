"""The agreement of a saliency on the vertices with human fixations (T3.3.6)."""

import itertools
from collections.abc import Mapping, Sequence

import numpy as np

from haptic_glance.look.agreement import GroundTruth, auc, cc, nss
from haptic_glance.mesh.mesh import Mesh

from .centres import centre_distance
from .concentration import half_share

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

    fixations: arrays of stages.weights.training_data; visible (3, n) boolean and by_view (3, n): the evaluated views
    and the saliency in each; whole (n,): the saliency over all views, used for nss and auc. pcc in a view weights each
    visible vertex by its area. pcc_masked is the thesis's number: over all vertices, with both maps scaled to 0..1 and
    the hidden vertices set to zero, so that visibility alone gives some correlation. distances: adds the distance
    between fixation centres in each view (T figure 3.36): the least in units, the same as a share of the diagonal
    (distance_share), the mean over the pairs (distance_mean), and that of the maxima to the letter (distance_maximum);
    and how concentrated the saliency is: half_share of what the view sees.
    """
    rows = []
    for view, (mask, values) in enumerate(zip(visible, by_view, strict=True)):
        truth = visible_truth(fixations, mask)
        if truth is None:
            continue
        found = {
            "pcc": cc(values[mask], truth),
            "pcc_masked": pearson(min_max_scaled(values) * mask, min_max_scaled(fixations["density"]) * mask),
        }
        if distances:
            least, mean = centre_distance(mesh.vertices, fixations["density"], values, mask)
            found |= {"distance": least, "distance_mean": mean, "distance_share": least / mesh.diagonal}
            found["distance_maximum"] = centre_distance(mesh.vertices, fixations["density"], values, mask, top=1)[0]
            found["half_share"] = half_share(values[mask], fixations["areas"][mask])
        rows += [{"view": view, "metric": metric, "value": none_if_nan(value)} for metric, value in found.items()]
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


def pearson(one: np.ndarray, other: np.ndarray) -> float:
    """Pearson's correlation of two arrays (n,); NaN where one is constant."""
    one, other = one - one.mean(), other - other.mean()
    size = np.sqrt((one @ one) * (other @ other))
    return float(one @ other / size) if size > 0 else np.nan


def none_if_nan(value: float) -> float | None:
    """The value, or None instead of NaN."""
    return value if np.isfinite(value) else None


def task_correlations(values: np.ndarray, seen: np.ndarray, names: Sequence[str]) -> list[dict]:
    """Rows of the correlation between the maps of each two tasks, the mean over the views (T figure 3.31).

    values (v, t, n), seen (v, n); over the vertices visible in a view. Views where one of the maps is constant are left
    out.
    """
    found = np.full((len(values), len(names), len(names)), np.nan)
    for view, visible in enumerate(seen):
        part = values[view][:, visible]
        varied = np.flatnonzero(np.ptp(part, axis=1) > 0) if visible.any() else []
        if len(varied) > 1:
            found[view][np.ix_(varied, varied)] = np.corrcoef(part[varied])
    rows = []
    for i, j in itertools.combinations(range(len(names)), 2):
        own = found[:, i, j][np.isfinite(found[:, i, j])]
        value = float(own.mean()) if len(own) else None
        rows.append({"task": f"{names[i]}~{names[j]}", "view": ALL_VIEWS, "metric": "pcc_tasks", "value": value})
    return rows
