"""Trains weights of the channels and the SVMs of T3.2.3: for all objects, all but one, one object or one viewpoint.

SVMs are trained on at most 1,000 pixels of the object. Pixels of the whole picture, as in the thesis, give a higher
accuracy, but almost all of it is due to separating the object from the background, and a worse ranking within the
object. Both are measured. With `picture` the SVMs of an object and of its views are trained as T3.2.3 prints it, on all
that `pixel_samples` draws from pictures of 200 x 200 pixels.

The accuracy on pixels is measured by random folds (T3.2.3), and on views or objects that are left out. Neighbouring
pixels are similar, so with random folds of pixels a model is tested on neighbours of its training pixels. The
difference between the two accuracies measures this leakage.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays
from haptic_glance.base.lazy import pandas as pd
from haptic_glance.base.rng import rng
from haptic_glance.look.agreement import gaze_peaks
from haptic_glance.look.channels import CHANNELS
from haptic_glance.look.glance import samples_of_mesh, standardised
from haptic_glance.look.weights.attention import view_distances, view_similarities
from haptic_glance.look.weights.convexity import convexity
from haptic_glance.look.weights.svm import (
    MAX_ROWS,
    balanced_rows,
    checked_rows,
    fit_rows,
    fit_svm,
    information_gains,
    pixel_samples,
)
from haptic_glance.look.weights.weights import ALL, GLANCES, METHODS, learned_weight_rows, weights, write_models
from haptic_glance.mesh.mesh import Mesh
from stages.conspicuity.measure import read_maps
from stages.engine.run import Rows

from .ground_truth import gts_map, spread_on_surface, visible_points

GAIN = "information_gain"
AREAS = {"image": "image_", "object": ""}  # area that the pixels were drawn from -> prefix of their arrays


def gain_rows(name: str, record: dict[str, np.ndarray], seed: int) -> Rows:
    """The information gain in bits of each channel about the pixels of an object, classes balanced (T3.2.3)."""
    rows = []
    for area, prefix in AREAS.items():
        pixels, labels = record[f"{prefix}pixels"], record[f"{prefix}labels"]
        if not 0 < labels.sum() < len(labels):
            continue
        drawn = balanced_rows(labels, rng(seed, "svm"), len(labels))
        gains = dict(zip(record["channels"], information_gains(pixels[drawn], labels[drawn]), strict=True))
        shared = {"item": name, "method": "svm", "area": area, "training": "one_per_object", "metric": GAIN}
        rows += [shared | {"channel": str(channel), "value": gain} for channel, gain in gains.items()]
    return rows


ROUNDING = 1e-9  # of the diagonal


def shape_rows(name: str, mesh: Mesh) -> Rows:
    """Measures of shape by which the thesis explains the gains of channels: convexity and the extremes (T3.2.3).

    `extremes` is the distance of the farthest vertex from the centre of mass of the surface over the mean distance,
    `distances_deviation` the deviation of the distances over their mean. Both distances are those of the middles of
    faces. A mesh with one face has neither of the two, since its one middle is the centre.
    """
    areas, middles = mesh.face_areas, mesh.vertices[mesh.faces].mean(axis=1)
    centre = np.average(middles, axis=0, weights=areas)
    distances = np.linalg.norm(middles - centre, axis=1)
    mean = np.average(distances, weights=areas)
    corners = mesh.vertices[np.unique(mesh.faces[areas > 0])]
    values = {"convexity": convexity(mesh)}
    if mean > ROUNDING * mesh.diagonal:
        values["extremes"] = np.linalg.norm(corners - centre, axis=1).max() / mean
        values["distances_deviation"] = np.sqrt(np.average((distances - mean) ** 2, weights=areas)) / mean
    return [{"item": name, "metric": metric, "value": float(value)} for metric, value in values.items()]


SPREAD = 0.025  # of the diagonal: deviation of the Gaussian that spreads gaze and marks over the surface
MAX_MARKS = 200  # more vertices than this are gaze, whose peaks are the points; fewer are marks, which are the points


def collect_training_data(
    name: str, mesh: Mesh, path: str | Path, amounts: np.ndarray, seed: int
) -> dict[str, np.ndarray]:
    """The training data of an object with n vertices and v views: dict name -> array.

    path: its file in data/SET/conspicuity; amounts (n,): of ground_truth_amounts. The arrays are amounts, density (n,)
    per unit of area, areas (n,); points (k,) vertex ids and shares (k,) of the attention; glance (s, e) f4, the
    features of s samples, glance_names (e,), glance_amounts and glance_areas (s,); distances, similarities and
    on_object (v, channels), the last being similarities without the background, NaN for a view without points; for the
    SVM pixels (p, channels) f4, labels (p,) and views (p,) drawn on the object, and image_pixels, image_labels and
    image_views drawn from the whole image as in the thesis. Raises ValueError for an empty ground truth.
    """
    density = spread_on_surface(mesh, amounts, SPREAD * mesh.diagonal)
    points, shares = ground_truth_points(mesh, amounts, density)
    maps, mask, viewpoints, map_channels = read_maps(path)
    channels = [channel for channel in CHANNELS if channel in map_channels]
    maps = maps[:, [map_channels.index(channel) for channel in channels]]
    samples = samples_of_mesh(mesh)
    glance = standardised(samples)
    views = [
        _view(
            f"{name} {viewpoint.name}",
            mesh,
            viewpoint,
            dict(zip(channels, maps[k], strict=True)),
            mask[k],
            points,
            seed,
        )
        for k, viewpoint in enumerate(viewpoints)
    ]
    tables, image, on_object = (list(part) for part in zip(*views, strict=True))
    if not any(view["distances"] for view in tables):
        raise ValueError("no view shows a point of its ground truth")
    return {
        "amounts": amounts,
        "density": density,
        "areas": mesh.vertex_areas,
        "points": points,
        "shares": shares,
        "glance": np.stack(list(glance.values()), axis=1).astype(np.float32),
        "glance_amounts": np.bincount(samples.tree.query(mesh.vertices)[1], amounts, minlength=len(samples.points)),
        "glance_areas": samples.areas,
        "glance_names": np.array(list(glance)),
        "channels": np.array(channels),
        **{kind: _table([view[kind] for view in tables], channels) for kind in tables[0]},
        **_rows("", on_object),
        **_rows("image_", image),
    }


def read_training_data(folder: Path) -> dict[str, dict[str, np.ndarray]]:
    """{object: arrays of collect_training_data} of the files NAME.npz in a folder, in alphabetical order."""
    files = {path.stem: path for path in folder.glob("*.npz")}
    return {name: read_arrays(files[name]) for name in sorted(files)}


def _table(views, channels):
    return np.array([[view.get(channel, np.nan) for channel in channels] for view in views])


def _rows(prefix, views):
    features, labels = zip(*views, strict=True)
    return {
        f"{prefix}pixels": np.concatenate(features).astype(np.float32),
        f"{prefix}labels": np.concatenate(labels),
        f"{prefix}views": np.repeat(np.arange(len(labels)), [len(view) for view in labels]),
    }


def ground_truth_points(mesh: Mesh, amounts: np.ndarray, density: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(vertices (k,), shares (k,)): the marked vertices, or for gaze the peaks of its density."""
    marked = np.flatnonzero(amounts)
    if len(marked) > MAX_MARKS:
        return gaze_peaks(mesh, density)
    order = marked[np.argsort(-amounts[marked], kind="stable")]
    return order, amounts[order] / amounts.sum()


def _view(name, mesh, viewpoint, maps, mask, points, seed):
    """(dict of channel values, SVM rows and labels of the whole image, the same on the object) of one view."""
    rows, columns, _ = visible_points(mesh, points, viewpoint, mask.shape)
    gts = gts_map(rows, columns, mask)
    tables = {
        "distances": view_distances(maps, rows, columns),
        "similarities": view_similarities(maps, gts),
        "on_object": view_similarities(maps, gts, mask) if mask.any() else {},
    }
    return tables, pixel_samples(maps, gts, seed, name), pixel_samples(maps, gts, seed, name, mask, share=1)


PIXELS = {"object": "", "picture": "image_"}  # what an object's own SVMs are trained on -> prefix of their arrays
MIN_ROWS = 40  # per model, so that each of ten folds has two of either class


def train_object(name: str, folder: Path, made: Path, seed: int, trained_on: str = "object") -> Rows:
    """Trains and stores the SVMs of one object, folder/svm/NAME.npz; returns rows with their accuracy.

    The models are `object`, trained on its own pixels, `view`, on those of one view each, and `without`, on all other
    objects. made: the folder with the training data of all objects; trained_on: one of PIXELS, of the first two.
    """
    training_data = read_training_data(made)
    record = training_data[name]
    features, labels, views = (record[f"{PIXELS[trained_on]}{key}"] for key in ("pixels", "labels", "views"))
    most = MAX_ROWS if trained_on == "object" else len(labels)
    per_view = [_fit(features[views == k], labels[views == k], seed, most) for k in range(len(record["distances"]))]
    other_arrays = [arrays for other, arrays in training_data.items() if other != name]
    other_svms = [_fit(*_joined_rows(other_arrays), seed)] if other_arrays else []
    models = {"object": [_fit(features, labels, seed, most)], "view": per_view, "without": other_svms}
    write_models(folder / "svm" / f"{name}.npz", models)
    rows = []
    for area, prefix in AREAS.items():
        features, labels, views = (record[f"{prefix}{key}"] for key in ("pixels", "labels", "views"))
        rows.append(_row(name, area, "one_per_object", "pixels", cross_validated, features, labels, seed))
        rows.append(_row(name, area, "one_per_object", "views", grouped_validated, features, labels, views, seed))
        for k in range(len(per_view)):
            part = views == k
            rows.append(
                _row(name, area, "one_per_viewpoint", "pixels", cross_validated, features[part], labels[part], seed)
            )
    return [*gain_rows(name, record, seed), *filter(None, rows)]


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


FOLDS = 10  # T3.2.3


def cross_validated(features: np.ndarray, labels: np.ndarray, seed: int) -> tuple[float, float]:
    """(mean, deviation) of the accuracy over ten random folds of rows, as in the thesis (T3.2.3).

    Rows are balanced and cut to MAX_ROWS first; the information gain is learned in each training part. Raises
    ValueError as fit_svm, and with fewer than two rows per class.
    """
    features, labels = checked_rows(features, labels, MAX_ROWS)
    generator = rng(seed, "svm folds")
    row_ids = balanced_rows(labels, generator, MAX_ROWS)
    fold = np.zeros(len(labels), dtype=np.int64)
    for value in (True, False):
        ids = generator.permutation(row_ids[labels[row_ids] == value])
        fold[ids] = np.arange(len(ids)) % FOLDS
    return _validated(features[row_ids], labels[row_ids], fold[row_ids])


def grouped_validated(features: np.ndarray, labels: np.ndarray, groups: np.ndarray, seed: int) -> tuple[float, float]:
    """(mean, deviation) of the accuracy on groups that are left out of the training: views or objects.

    groups (k,): the group of each row. Each group is balanced by itself, to at most an equal part of MAX_ROWS, so
    that guessing has an accuracy of 0.5 in each. Groups with a single class are left out. Up to ten groups are tested
    one by one, more in ten parts. Raises ValueError as fit_svm, and when fewer than two groups remain.
    """
    features, labels = checked_rows(features, labels, MAX_ROWS)
    groups = np.asarray(groups)
    if groups.shape != labels.shape:
        raise ValueError(f"groups must have one group per row: shape {labels.shape}, got {groups.shape}")
    generator = rng(seed, "svm groups")
    members = [np.flatnonzero(groups == name) for name in np.unique(groups)]
    members = [ids for ids in members if 0 < labels[ids].sum() < len(ids)]
    if len(members) < 2:
        raise ValueError(f"only {len(members)} groups hold both salient and other rows: at least 2 are needed")
    share = max(MAX_ROWS // len(members), 2)
    group_rows = [ids[balanced_rows(labels[ids], generator, share)] for ids in members]
    part = generator.permutation(len(members)) % FOLDS
    rows = np.concatenate(group_rows)
    return _validated(features[rows], labels[rows], np.repeat(part, [len(ids) for ids in group_rows]))


def _validated(features, labels, fold):
    accuracies = []
    for number in np.unique(fold):
        test = fold == number
        if len(np.unique(labels[~test])) < 2:
            raise ValueError(f"{len(labels)} rows are too few for training after a fold is left out: mark more points")
        predicted = fit_rows(features[~test], labels[~test]).predict(features[test]) > 0.5
        accuracies.append((predicted == labels[test]).mean())
    return float(np.mean(accuracies)), float(np.std(accuracies))


CHOICES = ("gaze", "fixations")  # published weights of GLANCES, or those learned from the data set


def weight_table(training_data: dict[str, dict[str, np.ndarray]], chosen: str) -> pd.DataFrame:
    """Frame with columns method, channel, weight, left_out.

    training_data: dict name -> arrays of collect_training_data, may be empty. chosen: of CHOICES, whether the weights
    of GLANCES are the published ones or learned. Raises ValueError for another choice, or for weights that cannot be
    learned for lack of ground truth.
    """
    if chosen not in CHOICES or (chosen == "fixations" and not training_data):
        reason = "" if training_data else "; no object has ground truth to learn from"
        raise ValueError(f"weights.method {chosen!r} is not available: choose {', '.join(CHOICES)}{reason}")
    rows = [
        {"method": method, "channel": channel, "weight": weight, "left_out": ALL}
        for method in METHODS
        if method not in GLANCES or chosen != "fixations"
        for channel, weight in weights(method).items()
    ]
    learned = learned_weight_rows(training_data) if training_data else []
    rows += [row for row in learned if row["method"] not in GLANCES or chosen == "fixations"]
    return pd.DataFrame(rows)


def weight_rows(table: pd.DataFrame) -> Rows:
    """The table as measurements: `item` is the object left out, empty where the weights are of all objects."""
    renamed = table.rename(columns={"left_out": "item", "weight": "value"})
    return renamed.assign(metric="weight").to_dict("records")  # type: ignore[return-value]  # names of columns are texts
