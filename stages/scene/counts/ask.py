"""The answers of each kind of model to the same cases, and the factor that makes them keep to the tolerance."""

import numpy as np

from .cases import HALF
from .models import KINDS, fit_counts
from .one_mesh import fit_power_law

ALL = (*KINDS, "one_mesh", "lookup")


def answers(kind, lessons, cases, combinations, seed):
    """(k,) i8: the counts of a model, trained on the curves `lessons`, for the cases; the lookup needs no lessons."""
    if kind == "lookup":
        return np.array([case.known.faces_needed(case.error) for case in cases])
    if kind == "one_mesh":
        return from_one_mesh(fit_power_law(lessons), cases)
    model = fit_counts(lessons, combinations, kind, seed)
    return ask_counts(model, cases)


def ask_counts(model, cases):
    """(k,) i8: what a Counts answers. A combination that the object has no curve of gets the case's own points."""
    points = {name: np.array([case.points.get(name, case.curve.points) for case in cases]) for name in model.regressors}
    tolerance = np.array([case.tolerance for case in cases])
    distance = np.array([case.distance for case in cases])
    initial = np.array([case.curve.initial_faces for case in cases])
    return model.faces_needed(tolerance, distance, initial, points)


def safety_factor(found, cases, rate):
    """What counts must be multiplied by so that `rate` of the cases get the faces that they need."""
    needed = np.array([case.needed for case in cases])
    return float(np.quantile(needed / found, rate, method="higher"))


def enlarged(found, factor, cases):
    """Counts times a factor, never more than the object has."""
    return np.minimum(np.ceil(found * factor), [case.curve.initial_faces for case in cases]).astype(np.int64)


def from_one_mesh(law, cases):
    """The known mesh that is nearest to half of the object's faces stands for the one mesh."""
    faces, errors = [], []
    for case in cases:
        nearest = np.abs(np.log(case.known.faces / (HALF * case.curve.initial_faces))).argmin()
        faces.append(case.known.faces[nearest])
        errors.append(case.known.errors[nearest])
    wanted = np.array([case.error for case in cases])
    initial = np.array([case.curve.initial_faces for case in cases])
    return law.faces_needed(wanted, np.array(faces), np.array(errors), initial)
