"""Weights learned from the lessons of several objects, leaving one out at a time."""

import numpy as np

from .euclidean import average, euclidean_weights
from .fixations import fit_fixations
from .similarity import similarity_weights

ALL = ""  # what `left_out` says where nothing was left out


def learned_rows(lessons):
    """Rows method, channel, weight, left_out: each way of learning from all objects, and from all but each one.

    lessons: dict name -> lesson. What is applied to an object must not have been learned from it, or its agreement
    with people says nothing: an object with ground truth takes the row that leaves it out. With one object alone there
    is nothing to learn for it, and only the rows from all are there.
    """
    folds = [ALL, *lessons] if len(lessons) > 1 else [ALL]
    per_object = {name: _views(lesson) for name, lesson in lessons.items()}
    rows = []
    for left_out in folds:
        kept = [name for name in lessons if name != left_out]
        found = {
            "guided_ed": average([per_object[name][0] for name in kept]),
            "guided_ssim": average([per_object[name][1] for name in kept]),
            "guided_ssim_object": average([per_object[name][2] for name in kept]),
            "fixations": _fixations([lessons[name] for name in kept]),
        }
        rows += [
            {"method": method, "channel": channel, "weight": round(weight, 9), "left_out": left_out}
            for method, weights in found.items()
            for channel, weight in weights.items()
        ]
    return rows


def _views(lesson):
    """(weights by distance, by similarity, by similarity on the object) of one object, its views averaged (T3.2.1)."""
    distances, similarities, on_object = (_dicts(lesson, kind) for kind in ("distances", "similarities", "on_object"))
    return euclidean_weights(distances), similarity_weights(similarities), similarity_weights(on_object)


def _dicts(lesson, kind):
    """One dict channel -> value a view; empty for a view that shows no ground truth."""
    channels = [str(channel) for channel in lesson["channels"]]
    return [dict(zip(channels, row, strict=True)) if np.isfinite(row).all() else {} for row in lesson[kind]]


def _fixations(lessons):
    weights = fit_fixations(*zip(*((one["features"], one["amounts"], one["areas"]) for one in lessons), strict=True))
    return dict(zip((str(name) for name in lessons[0]["names"]), weights.tolist(), strict=True))
