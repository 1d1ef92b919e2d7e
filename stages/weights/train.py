"""The SVMs of T3.2.3: one for all objects, one an object, one a viewpoint; and one for all but each object.

They are trained on pixels of the object. The thesis's pixels of the whole image give higher accuracies, nearly all of
which tell the object from the background, and a worse order of its own pixels; both are measured.
"""

import numpy as np

from .learned import write_models
from .svm import fit_svm
from .svm_validation import cross_validated, grouped_validated

AREAS = {"image": "image_", "object": ""}  # where the pixels of a lesson were drawn -> how their arrays begin
FEWEST = 40  # rows a model, so that each of ten folds tests two of either class


def train_object(name, folder, lessons, seed):
    """Trains and stores the SVMs of one object, folder/svm/NAME.npz; returns rows of their accuracy.

    Arrays `object`, from its own pixels, `view`, from those of one view each, and `without`, from all other objects.
    """
    own = lessons[name]
    features, labels, views = own["pixels"], own["labels"], own["views"]
    per_view = [_fit(features[views == k], labels[views == k], seed) for k in range(len(own["distances"]))]
    others = [lesson for other, lesson in lessons.items() if other != name]
    without = [_fit(*_together(others), seed)] if others else []
    models = {"object": [_fit(features, labels, seed)], "view": per_view, "without": without}
    write_models(folder / "svm" / f"{name}.npz", models)
    rows = []
    for area, prefix in AREAS.items():
        features, labels, views = (own[f"{prefix}{key}"] for key in ("pixels", "labels", "views"))
        rows.append(_row(name, area, "one_per_object", "pixels", cross_validated, features, labels, seed))
        rows.append(_row(name, area, "one_per_object", "views", grouped_validated, features, labels, views, seed))
        for k in range(len(per_view)):
            part = views == k
            rows.append(
                _row(name, area, "one_per_viewpoint", "pixels", cross_validated, features[part], labels[part], seed)
            )
    return [row for row in rows if row]


def train_all(folder, lessons, seed):
    """Trains and stores the SVM for all objects, folder/svm.npz; returns rows of its accuracy."""
    features, labels = _together(list(lessons.values()))
    write_models(folder / "svm.npz", {"all": [_fit(features, labels, seed)]})
    rows = []
    for area, prefix in AREAS.items():
        features, labels = _together(list(lessons.values()), prefix)
        objects = np.repeat(list(lessons), [len(lesson[f"{prefix}labels"]) for lesson in lessons.values()])
        rows.append(_row("all", area, "one_for_all", "pixels", cross_validated, features, labels, seed))
        rows.append(_row("all", area, "one_for_all", "objects", grouped_validated, features, labels, objects, seed))
    return [row for row in rows if row]


def _together(lessons, prefix=""):
    return tuple(np.concatenate([lesson[f"{prefix}{key}"] for lesson in lessons]) for key in ("pixels", "labels"))


def _fit(features, labels, seed):
    """A model, or None where one class is missing."""
    return fit_svm(features, labels, seed) if 0 < labels.sum() < len(labels) else None


def _row(name, area, training, validation, validate, features, labels, *rest):
    """One accuracy; None where there are too few rows, or groups, to leave any out."""
    if min(labels.sum(), (~labels).sum()) < FEWEST // 2 or (validation != "pixels" and len(np.unique(rest[0])) < 2):
        return None
    accuracy, deviation = validate(features, labels, *rest)
    row = {"object": name, "method": "svm", "area": area, "training": training, "validation": validation}
    # What one gets for only telling the object from the background: maps are zero off the object.
    plain = float((features.any(axis=1) == labels).mean())
    row |= {"deviation": deviation, "background_alone": plain, "seconds": None}
    return row | {"metric": "accuracy", "value": accuracy}
