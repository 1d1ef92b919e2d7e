"""How well methods agree with people, on an object that has ground truth (T3.2.3; Dutagaci 2012; Bylinskii 2019)."""

import numpy as np

from stages.weights.agreement import Truth, agreement, interest_point_errors
from stages.weights.lessons import SPREAD
from stages.weights.truth import spread_on_surface

AT = (0.02, 0.05, 0.1)  # of the diagonal: tolerances at which the errors of the points are noted
HUMAN = "human"  # the ground truth judged by itself: as far as a density of this smoothness can come


def judged(mesh, lesson, found):
    """Rows of metrics: cc, nss, auc, sim, kl of every method's saliency, and fne, fpe, wme of its points.

    lesson: arrays of stages.weights.lessons; found: dict method -> Found. A method that only chooses places has as its
    saliency its points, spread as far as the truth is. The errors of the points are of the strong ones, at the
    tolerances AT (shares of the diagonal), as metric `fne@0.05` and so on.
    """
    truth = Truth(lesson["amounts"], lesson["density"], lesson["areas"])
    rows = [(HUMAN, name, value) for name, value in agreement(lesson["density"], truth).items()]
    for method, result in found.items():
        values = _as_density(mesh, result) if result.saliency is None else result.saliency
        rows += [(method, name, value) for name, value in agreement(values, truth).items()]
        strong = result.points[: result.strong]
        errors = interest_point_errors(mesh, strong, lesson["points"], lesson["shares"], np.array(AT))
        rows += [
            (method, f"{error}@{tolerance}", float(value))
            for error, values in errors.items()
            for tolerance, value in zip(AT, values, strict=True)
        ]
    return [{"method": method, "metric": metric, "value": value} for method, metric, value in rows]


def _as_density(mesh, result):
    marks = np.zeros(len(mesh.vertices))
    marks[result.points[: result.strong]] = 1
    return spread_on_surface(mesh, marks, SPREAD * mesh.diagonal)
