"""How well an attention on the vertices agrees with people (T3.3.6)."""

import numpy as np

from stages.weights.agreement import Truth, auc, cc, nss

from .centres import centre_distance

WHOLE = "all"  # all views together


def judged(mesh, lesson, seen, by_view, whole, places=True):
    """Rows of view, metric, value: one saliency against the people's.

    lesson: arrays of stages.weights.lessons; seen (3, n) boolean and by_view (3, n): the three views and the
    saliency in each; whole (n,): all views in one, which nss and auc are of. pcc, of a view over the vertices that
    it sees, weighs each vertex by its area. pcc_masked is the thesis's number, over all vertices with the hidden
    ones set to zero in both, each scaled to 0..1 before: to know what is visible already gives some of it. With
    places, a view's distance between fixation centres too (T figure 3.36): the least in units and as distance_share
    of the diagonal, distance_mean over the pairs.
    """
    rows = []
    for view, (visible, values) in enumerate(zip(seen, by_view, strict=True)):
        truth = truth_of(lesson, visible)
        if truth is None:
            continue
        found = {
            "pcc": cc(values[visible], truth),
            "pcc_masked": pearson(scaled(values) * visible, scaled(lesson["density"]) * visible),
        }
        if places:
            least, mean = centre_distance(mesh.vertices, lesson["density"], values, visible)
            found |= {"distance": least, "distance_mean": mean, "distance_share": least / mesh.diagonal}
        rows += [{"view": view, "metric": metric, "value": number(value)} for metric, value in found.items()]
    truth = Truth(lesson["amounts"], lesson["density"], lesson["areas"])
    return rows + [
        {"view": WHOLE, "metric": metric, "value": function(whole, truth)}
        for metric, function in (("pcc", cc), ("nss", nss), ("auc", auc))
    ]


def truth_of(lesson, visible):
    """The Truth of what a view sees, None where nobody looked at it."""
    amounts, density, areas = (lesson[key][visible] for key in ("amounts", "density", "areas"))
    return Truth(amounts, density, areas) if amounts.any() and (density * areas).any() else None


def scaled(values):
    """Values (n,) from 0 to 1; zero where they are all alike."""
    low, high = values.min(), values.max()
    return (values - low) / (high - low) if high > low else np.zeros_like(values)


def pearson(one, other):
    """Pearson's correlation of two arrays (n,); NaN where one is constant."""
    one, other = one - one.mean(), other - other.mean()
    size = np.sqrt((one @ one) * (other @ other))
    return float(one @ other / size) if size > 0 else np.nan


def number(value):
    """The value, None in the place of NaN."""
    return value if np.isfinite(value) else None


def between_tasks(values, seen, names):
    """Rows of the correlation of each two tasks, the mean over the views (T figure 3.31).

    values (v, t, n), seen (v, n); over the vertices that a view sees. A map that is constant there correlates with
    nothing: such a view is left out.
    """
    found = np.full((len(values), len(names), len(names)), np.nan)
    for view, visible in enumerate(seen):
        part = values[view][:, visible]
        varied = np.flatnonzero(np.ptp(part, axis=1) > 0) if visible.any() else []
        if len(varied) > 1:
            found[view][np.ix_(varied, varied)] = np.corrcoef(part[varied])
    rows = []
    for i, j in zip(*np.triu_indices(len(names), 1), strict=True):
        own = found[:, i, j][np.isfinite(found[:, i, j])]
        value = float(own.mean()) if len(own) else None
        rows.append({"task": f"{names[i]}~{names[j]}", "view": WHOLE, "metric": "pcc_tasks", "value": value})
    return rows
