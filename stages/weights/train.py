"""Trains the SVMs of T3.2.3: one for all objects, one per object, one per viewpoint; and one for all but each object.

They are trained on at most 1,000 pixels of the object. Pixels of the whole picture, as in the thesis, give a higher
accuracy, but almost all of it is due to separating the object from the background, and a worse ranking within the
object. Both are measured. With `picture` the SVMs of an object and of its views are trained as T3.2.3 prints it, on all
that `pixel_samples` draws from pictures of 200 x 200 pixels.
"""

from pathlib import Path

import numpy as np

from haptic_glance.look.weights.svm import MAX_ROWS, fit_svm
from haptic_glance.look.weights.weights import write_models
from stages.kit.run import Rows

from .svm_validation import cross_validated, grouped_validated
from .training_data import read_training_data

AREAS = {"image": "image_", "object": ""}  # area that the pixels were drawn from -> prefix of their arrays
PIXELS = {"object": "", "picture": "image_"}  # what an object's own SVMs are trained on -> prefix of their arrays
MIN_ROWS = 40  # per model, so that each of ten folds has two of either class


def check_pixels(name: str) -> None:
    """Raises ValueError unless `name` is one of PIXELS."""
    if name not in PIXELS:
        raise ValueError(f"weights.svm={name!r}: choose one of {', '.join(PIXELS)}")


def train_object(name: str, folder: Path, made: Path, seed: int, trained_on: str = "object") -> Rows:
    """Trains and stores the SVMs of one object, folder/svm/NAME.npz; returns rows with their accuracy.

    The models are `object`, trained on its own pixels, `view`, on those of one view each, and `without`, on all other
    objects. made: the folder with the training data of all objects; trained_on: one of PIXELS, of the first two.
    """
    training_data = read_training_data(made)
    own = training_data[name]
    features, labels, views = (own[f"{PIXELS[trained_on]}{key}"] for key in ("pixels", "labels", "views"))
    most = MAX_ROWS if trained_on == "object" else len(labels)
    per_view = [_fit(features[views == k], labels[views == k], seed, most) for k in range(len(own["distances"]))]
    others = [arrays for other, arrays in training_data.items() if other != name]
    without = [_fit(*_joined_rows(others), seed)] if others else []
    models = {"object": [_fit(features, labels, seed, most)], "view": per_view, "without": without}
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


def train_all(folder: Path, training_data: dict[str, dict[str, np.ndarray]], seed: int) -> Rows:
    """Trains and stores the SVM for all objects, folder/svm.npz; returns rows with its accuracy."""
    features, labels = _joined_rows(list(training_data.values()))
    write_models(folder / "svm.npz", {"all": [_fit(features, labels, seed)]})
    rows = []
    for area, prefix in AREAS.items():
        features, labels = _joined_rows(list(training_data.values()), prefix)
        objects = np.repeat(list(training_data), [len(arrays[f"{prefix}labels"]) for arrays in training_data.values()])
        rows.append(_row("", area, "one_for_all", "pixels", cross_validated, features, labels, seed))
        rows.append(_row("", area, "one_for_all", "objects", grouped_validated, features, labels, objects, seed))
    return [row for row in rows if row]


def _joined_rows(objects, prefix=""):
    pixels, labels = ([arrays[f"{prefix}{key}"] for arrays in objects] for key in ("pixels", "labels"))
    return np.concatenate(pixels), np.concatenate(labels)


def _fit(features, labels, seed, max_rows=MAX_ROWS):
    """A model, or None if a class is missing."""
    return fit_svm(features, labels, seed, max_rows) if 0 < labels.sum() < len(labels) else None


def _row(name, area, training, validation, validate, features, labels, *rest):
    """One row with an accuracy; None if there are too few rows, or groups, to leave any out."""
    if min(labels.sum(), (~labels).sum()) < MIN_ROWS // 2 or (validation != "pixels" and len(np.unique(rest[0])) < 2):
        return None
    accuracy, deviation = validate(features, labels, *rest)
    row = {"item": name, "method": "svm", "area": area, "training": training, "validation": validation}
    # The accuracy of labelling every pixel of the object as salient: maps are zero off the object.
    baseline = float((features.any(axis=1) == labels).mean())
    row |= {"deviation": deviation, "background_alone": baseline, "seconds": None}
    return row | {"metric": "accuracy", "value": accuracy}
