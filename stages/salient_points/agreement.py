"""How well methods agree with people, on an object that has ground truth (T3.2.3; Dutagaci 2012; Bylinskii 2019)."""

from collections.abc import Mapping

import numpy as np

from haptic_glance.look.agreement import GroundTruth, agreement, interest_point_errors
from haptic_glance.look.points.options import Detection
from haptic_glance.mesh.mesh import Mesh
from stages.weights.ground_truth import spread_on_surface
from stages.weights.training_data import SPREAD

TOLERANCES = (0.02, 0.05, 0.1)  # of the diagonal: where the errors of the points are measured
HUMAN = "human"  # the ground truth scored against itself: the best that a density of this smoothness can reach


def agreement_rows(mesh: Mesh, ground_truth: Mapping[str, np.ndarray], found: Mapping[str, Detection]) -> list[dict]:
    """Rows of metrics: cc, nss, auc, sim, kl of every method's saliency, and fne, fpe, wme of its points.

    ground_truth: arrays of stages.weights.training_data; found: dict method -> Detection. A method that only places
    points gets, as its saliency, these points spread as far as the ground truth is. The errors of the points are those
    of the strong ones, at the TOLERANCES (shares of the diagonal), as metric `fne@0.05` and so on.
    """
    truth = GroundTruth(ground_truth["amounts"], ground_truth["density"], ground_truth["areas"])
    rows = [(HUMAN, name, value) for name, value in agreement(ground_truth["density"], truth).items()]
    for method, result in found.items():
        values = _as_density(mesh, result) if result.saliency is None else result.saliency
        rows += [(method, name, value) for name, value in agreement(values, truth).items()]
        strong = result.points[: result.strong]
        errors = interest_point_errors(
            mesh, strong, ground_truth["points"], ground_truth["shares"], np.array(TOLERANCES)
        )
        rows += [
            (method, f"{error}@{tolerance}", float(value))
            for error, values in errors.items()
            for tolerance, value in zip(TOLERANCES, values, strict=True)
        ]
    return [{"method": method, "metric": metric, "value": value} for method, metric, value in rows]


def _as_density(mesh, result):
    marks = np.zeros(len(mesh.vertices))
    marks[result.points[: result.strong]] = 1
    return spread_on_surface(mesh, marks, SPREAD * mesh.diagonal)
