"""The predictions of each kind of model for the same cases, and the factor with which they meet the tolerance."""

from collections.abc import Sequence

import numpy as np

from .cases import HALF, Case
from .curves import Curve
from .models import KINDS, Counts, fit_counts
from .one_mesh import PowerLaw, fit_power_law

ALL = (*KINDS, "one_mesh", "lookup")


def predict_counts(
    kind: str, training: Sequence[Curve], cases: Sequence[Case], combinations: Sequence[str], seed: int
) -> np.ndarray:
    """(k,) i8: the counts of a model, trained on the curves `training`, for the cases; the lookup needs none."""
    if kind == "lookup":
        return np.array([case.given.faces_needed(case.error) for case in cases])
    if kind == "one_mesh":
        return from_one_mesh(fit_power_law(training), cases)
    model = fit_counts(training, combinations, kind, seed)
    return predict_with(model, cases)


def predict_with(model: Counts, cases: Sequence[Case]) -> np.ndarray:
    """(k,) i8: the predictions of a Counts. For a combination without a curve of the object, the case's points."""
    points = {name: np.array([case.points.get(name, case.curve.points) for case in cases]) for name in model.regressors}
    tolerance = np.array([case.tolerance for case in cases])
    distance = np.array([case.distance for case in cases])
    initial = np.array([case.curve.initial_faces for case in cases])
    return np.asarray(model.faces_needed(tolerance, distance, initial, points))


def safety_factor(counts: np.ndarray, cases: Sequence[Case], rate: float) -> float:
    """The factor on the counts with which the share `rate` of the cases gets enough faces."""
    needed = np.array([case.needed for case in cases])
    return float(np.quantile(needed / counts, rate, method="higher"))


def enlarged(counts: np.ndarray, factor: float, cases: Sequence[Case]) -> np.ndarray:
    """Counts times a factor, at most those of the full mesh."""
    return np.minimum(np.ceil(counts * factor), [case.curve.initial_faces for case in cases]).astype(np.int64)


def from_one_mesh(law: PowerLaw, cases: Sequence[Case]) -> np.ndarray:
    """(k,) i8: the power law from the given mesh nearest to half of the object's faces."""
    faces, errors = [], []
    for case in cases:
        nearest = np.abs(np.log(case.given.faces / (HALF * case.curve.initial_faces))).argmin()
        faces.append(case.given.faces[nearest])
        errors.append(case.given.errors[nearest])
    target = np.array([case.error for case in cases])
    initial = np.array([case.curve.initial_faces for case in cases])
    return np.asarray(law.faces_needed(target, np.array(faces), np.array(errors), initial))
