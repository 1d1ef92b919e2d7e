"""Learns weights from the training data of several objects, leaving one object out at a time."""

import numpy as np

from .euclidean import average, euclidean_weights
from .fixations import fit_fixations
from .published import GLANCES
from .similarity import similarity_weights

ALL = ""  # the value of `left_out` for weights learned from all objects


def learned_weight_rows(training_data: dict[str, dict[str, np.ndarray]]) -> list[dict]:
    """Rows of method, channel, weight, left_out: the weights learned from all objects, and from all but each one.

    training_data: dict name -> arrays of collect_training_data. An object with ground truth must use the row that
    leaves it out, since the agreement with people is meaningless for weights that were learned from the same object.
    With a single object, only the rows learned from all objects exist.
    """
    folds = [ALL, *training_data] if len(training_data) > 1 else [ALL]
    per_object = {name: _views(arrays) for name, arrays in training_data.items()}
    rows = []
    for left_out in folds:
        kept = [name for name in training_data if name != left_out]
        found = {
            "guided_ed": average([per_object[name][0] for name in kept]),
            "guided_ssim": average([per_object[name][1] for name in kept]),
            "guided_ssim_object": average([per_object[name][2] for name in kept]),
            **{method: _glance([training_data[name] for name in kept], method) for method in GLANCES},
        }
        rows += [
            {"method": method, "channel": channel, "weight": round(weight, 9), "left_out": left_out}
            for method, weights in found.items()
            for channel, weight in weights.items()
        ]
    return rows


def _views(arrays):
    """(weights by distance, by similarity, by similarity on the object) of one object, averaged over views (T3.2.1)."""
    distances, similarities, on_object = (_dicts(arrays, kind) for kind in ("distances", "similarities", "on_object"))
    return euclidean_weights(distances), similarity_weights(similarities), similarity_weights(on_object)


def _dicts(arrays, kind):
    """One dict channel -> value per view; empty for a view that shows no ground truth."""
    channels = [str(channel) for channel in arrays["channels"]]
    return [dict(zip(channels, row, strict=True)) if np.isfinite(row).all() else {} for row in arrays[kind]]


def _glance(objects, method):
    """The weights of a method of GLANCES."""
    names = list(GLANCES[method])
    columns = [objects[0]["glance_names"].tolist().index(name) for name in names]
    amounts, areas = ([one[key] for one in objects] for key in ("glance_amounts", "glance_areas"))
    weights = fit_fixations([one["glance"][:, columns] for one in objects], amounts, areas)
    return dict(zip(names, weights.tolist(), strict=True))
