"""Trains networks for the tasks: linear heads on pooled maps, or the layers below as well (T3.3.3).

A frozen network has one head per task. Modes `last_block` and `finetuned` train one network per task.
"""

import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import torch
from sklearn.exceptions import ConvergenceWarning
from sklearn.linear_model import LogisticRegression
from threadpoolctl import threadpool_limits

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep.cam import grad_cam
from haptic_glance.deep.device import choose_device, device_of, explain_out_of_memory, mixed_precision, repeatable
from haptic_glance.deep.images import normalise
from haptic_glance.deep.modes import Task
from haptic_glance.deep.network import Network, build, recalibrate
from haptic_glance.deep.training import Learning, search_rate, train_model

from . import Params
from .backbone import (
    BATCH,
    MODES,
    Method,
    augmentation,
    cached_task,
    network_inputs,
    read_pictures,
    read_trunk,
    to_images,
)
from .tasks import object_folds, random_views

Tasks = Mapping[str, Mapping[str, str]]  # task -> {object: its class}
OF_LAST_BLOCK = "last_block"


@explain_out_of_memory()
def choose_rate(
    name: str,
    folder: Path,
    made: Path,
    method: Method,
    settings: Params,
    objects: Sequence[str],
    tasks: Tasks,
    seed: int,
) -> list[dict]:
    """Stores the learning rate of mode `last_block`; returns a row with it.

    It is the one with the best accuracy on the validation views after one pass, on the task with the most classes.
    name: of the method; made: the folder of the trunk's maps; objects: all of them.
    """
    task = max(tasks, key=lambda candidate: len(set(tasks[candidate].values())))
    labels = labels_of(objects, tasks[task], settings)
    part, validation, _ = divided(labels, seed)
    with repeatable(seed), Stopwatch() as watch:
        options = {"epochs": 1, "batch": settings.batch, "momentum": settings.momentum, "seed": seed}
        lesson, _, _ = lesson_of(made, method, settings, objects, labels.max() + 1, seed)
        rate, accuracy = search_rate(lesson, labels, part, validation, settings.rates, **options)
    write_arrays(folder / ".rates" / f"{name}.npz", rate=rate, seconds=watch.seconds)
    note = f"validation accuracy {accuracy:.3f} after one pass"
    return [{"method": name, "task": task, "metric": "rate", "value": rate, "seconds": watch.seconds, "note": note}]


@explain_out_of_memory()
def train_network(
    task: str,
    folder: Path,
    made: Path,
    method: Method,
    settings: Params,
    objects: Sequence[str],
    tasks: Tasks,
    seed: int,
) -> list[dict]:
    """Trains the network of one task on the training views and stores its Grad-CAM maps of all views.

    Returns rows of its accuracy on the test views. made: the folder of the pictures, of the trunk's maps and the
    learning rate; objects: all of them. The split of views is that of the frozen heads. The rate of mode `finetuned` is
    fixed, so that the validation views are not used. Raises Diverged where the loss is not finite.
    """
    labels = labels_of(objects, tasks[task], settings)
    part, _, test = divided(labels, seed)
    rate_arrays = read_arrays(made / ".rates" / f"{method.name}.npz") if method.mode == OF_LAST_BLOCK else {}
    options = {name: getattr(settings, name) for name in ("epochs", "batch", "momentum")}
    options["rate"] = float(rate_arrays.get("rate", settings.rate))
    with repeatable(seed), Stopwatch() as training:
        lesson, trunk, copies = lesson_of(made, method, settings, objects, labels.max() + 1, seed)
        checkpoint = folder / "training.pt"
        model = train_model(lesson, labels, part, **options, checkpoint=checkpoint, learning=Learning())
    with repeatable(seed), Stopwatch() as looking:
        cams, predicted = look(model, lesson, len(labels))
    seconds = (looking.seconds + trunk / len(tasks)) / len(objects)
    cams = cams.reshape(len(objects), -1, *cams.shape[1:])
    write_arrays(folder / ".cams" / method.name / f"{task}.npz", cams=cams, objects=np.array(objects), seconds=seconds)
    cost = training.seconds + (copies + float(rate_arrays.get("seconds", 0))) / len(tasks)
    row = {"method": method.name, "task": task, "split": "views"}
    return [
        row | {"metric": "accuracy", "value": float((predicted[test] == labels[test]).mean()), "seconds": cost},
        row | {"metric": "chance", "value": majority_accuracy(labels, part, test)},
    ]


def labels_of(objects: Sequence[str], classes: Mapping[str, str], settings: Params) -> np.ndarray:
    """(n,) i8: the number of the class of each picture of the objects, -1 for an object without one."""
    names, views = sorted(set(classes.values())), settings.parallels * settings.azimuths + 2
    return np.repeat([names.index(classes[name]) if name in classes else -1 for name in objects], views)


def divided(labels: np.ndarray, seed: int) -> list[np.ndarray]:
    """[train, validation, test]: ids of the pictures with a class.

    A picture is in the same part for every task, whichever objects the tasks name. One task chooses the learning rate
    for all tasks: no picture that chooses is one that tests.
    """
    return [ids[labels[ids] >= 0] for ids in random_views(len(labels), rng(seed, "fixation views"))]


def lesson_of(
    made: Path, method: Method, settings: Params, objects: Sequence[str], classes: int, seed: int
) -> tuple[Task, float, float]:
    """(the Task of a method, seconds of its trunk for the pictures, and for their augmented copies)."""
    cached = method.mode == OF_LAST_BLOCK
    network = build(method.network, classes, MODES[method.mode], seed, settings.source, fully_connected=cached)
    network = network.to(choose_device(settings.device))
    if cached:
        maps, once, again = read_trunk(made, method.name, objects)
        return cached_task(network, method, maps), once, again
    return training_task(network, np.concatenate([read_pictures(made, name)[0] for name in objects])), 0.0, 0.0


def training_task(network: Network, pictures: np.ndarray) -> Task:
    """The Task to train every layer on grey pictures (k, h, w) u1, rotated and rescaled at random."""
    network.requires_grad_(True)
    augment, device = augmentation(), device_of(network)

    def plain(ids):
        return network_inputs(pictures[np.asarray(ids)], device)

    def augmented(ids):
        return normalise(augment(to_images(pictures[np.asarray(ids)], device)))

    def finish(model, ids):
        recalibrate(model, plain, ids, BATCH)

    return Task(network, augmented, plain, finish, lambda images: normalise(images.to(device)))


@torch.no_grad()
def look(model: torch.nn.Module, lesson: Task, count: int) -> tuple[np.ndarray, np.ndarray]:
    """((n, i, j) f4 Grad-CAM maps, (n,) i8 predicted classes) of the first `count` pictures of a task."""
    assert isinstance(model, Network)
    batches = []
    for ids in torch.arange(count).split(BATCH):
        with explain_out_of_memory(), mixed_precision(device_of(model)):
            batches.append(grad_cam(model.convolutions(lesson.inputs(ids)), model.classify))
    cams, classes = zip(*batches, strict=True)
    return np.concatenate(cams), np.concatenate(classes)


def read_cams(made: Path, method: str, name: str, tasks: Sequence[str]) -> tuple[dict[str, np.ndarray], float]:
    """(dict task -> (v, i, j) f4 Grad-CAM maps of one object, seconds of its networks)."""
    cams, seconds = {}, 0.0
    for task in tasks:
        arrays = read_arrays(made / ".cams" / method / f"{task}.npz")
        cams[task] = arrays["cams"][arrays["objects"].tolist().index(name)]
        seconds += float(arrays["seconds"])
    return cams, seconds


ITERATIONS = 200  # of the solver; the maps do not need full convergence


def fit_head(features: np.ndarray, labels: np.ndarray, penalty: float) -> tuple[np.ndarray, np.ndarray]:
    """(weights (k, C), bias (k,)) of a softmax head fitted to features (n, C) with labels (n,) in 0..k-1.

    Minimises the cross-entropy with an L2 penalty on standardised features. The standardisation is folded into the
    weights, so that the head is one linear layer on the pooled maps. The scores of two classes are opposite. penalty:
    inverse strength of the regularisation.
    """
    mean, spread = features.mean(axis=0), features.std(axis=0)
    spread = np.where(spread > 1e-6 * max(spread.max(), 1e-30), spread, np.inf)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)
        fit = LogisticRegression(C=penalty, max_iter=ITERATIONS).fit((features - mean) / spread, labels)
    weights, bias = fit.coef_, fit.intercept_
    if len(weights) == 1:
        weights, bias = np.concatenate([-weights, weights]) / 2, np.concatenate([-bias, bias]) / 2
    weights = weights / spread
    return weights, bias - weights @ mean


def scores(features: np.ndarray, weights: np.ndarray, bias: np.ndarray) -> np.ndarray:
    """(n, k): the scores before the softmax."""
    return features @ weights.T + bias


def train_head(
    task: str,
    folder: Path,
    made: Path,
    method: Method,
    settings: Params,
    objects: Sequence[str],
    tasks: Tasks,
    seed: int,
) -> list[dict]:
    """Trains the head of one task and writes heads/METHOD/TASK.npz; returns rows of its accuracy.

    made: the folder of the pooled maps; objects: all of them. The penalty is the one with the best validation accuracy,
    the strongest of equals. The maps come from the head of the random split of views, as in the thesis.
    """
    classes, ids, features = read_features(made, method.name, tasks[task])
    labels = labels_of(objects, tasks[task], settings)
    with threadpool_limits(1), Stopwatch() as watch:
        parts = divided(labels, seed)
        train, validation, test = (np.searchsorted(np.flatnonzero(labels >= 0), part) for part in parts)
        accuracies = [
            head_accuracy(features, ids, classes, train, validation, penalty) for penalty in settings.penalties
        ]
        penalty = settings.penalties[int(np.argmax(accuracies))]
        names, numbers = np.unique(classes[ids][train], return_inverse=True)
        weights, bias = fit_head(features[train], numbers, penalty)
    write_arrays(
        folder / "heads" / method.name / f"{task}.npz",
        weights=weights.astype(np.float32), bias=bias.astype(np.float32), classes=names,
    )  # fmt: skip
    predicted = names[scores(features[test], weights, bias).argmax(axis=1)]
    row = {"method": method.name, "task": task}
    rows = [
        row | {"split": "views", "metric": "accuracy", "value": float((predicted == classes[ids][test]).mean())},
        row | {"split": "views", "metric": "chance", "value": majority_accuracy(classes[ids], train, test)},
    ]
    rows[0]["seconds"] = watch.seconds
    with threadpool_limits(1):
        unseen = unseen_object_rows(features, ids, classes, settings.penalties, settings.folds, rng(seed, task))
    return rows + [row | cells for cells in unseen]


def read_features(folder: Path, method: str, classes: Mapping[str, str]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(class names (k,) of the objects, ids (n,) of the object of each picture, features (n, C) of the pictures)."""
    parts = [read_arrays(folder / ".pooled" / method / f"{name}.npz")["pooled"] for name in classes]
    return (
        np.array(list(classes.values())),
        np.repeat(np.arange(len(parts)), [len(p) for p in parts]),
        np.concatenate(parts),
    )


def head_accuracy(
    features: np.ndarray, ids: np.ndarray, classes: np.ndarray, train: np.ndarray, test: np.ndarray, penalty: float
) -> float:
    """The accuracy on the test pictures of a head fitted to the training pictures."""
    names, numbers = np.unique(classes[ids[train]], return_inverse=True)
    predicted = names[scores(features[test], *fit_head(features[train], numbers, penalty)).argmax(axis=1)]
    return float((predicted == classes[ids[test]]).mean())


def unseen_object_rows(
    features: np.ndarray,
    ids: np.ndarray,
    classes: np.ndarray,
    penalties: Sequence[float],
    folds: int,
    generator: np.random.Generator,
) -> list[dict]:
    """Rows of the accuracy on held-out objects, over all objects whose class has another one.

    The penalty is chosen on the next fold, by heads that are trained on neither.
    """
    fold = object_folds(classes, folds, generator)
    outcomes = []
    numbers = np.unique(fold[fold >= 0])
    for number, following in zip(numbers, np.roll(numbers, -1), strict=True):
        train, test = np.flatnonzero(fold[ids] != number), np.flatnonzero(fold[ids] == number)
        if len(np.unique(classes[ids[train]])) > 1:
            part, check = train[fold[ids[train]] != following], train[fold[ids[train]] == following]
            penalty = penalties[0]
            if len(check) and len(np.unique(classes[ids[part]])) > 1:
                accuracies = [head_accuracy(features, ids, classes, part, check, strength) for strength in penalties]
                penalty = penalties[int(np.argmax(accuracies))]
            values = (
                head_accuracy(features, ids, classes, train, test, penalty),
                majority_accuracy(classes[ids], train, test),
            )
            outcomes.append((*values, len(test)))
    if not outcomes:
        return [{"split": "objects", "metric": "accuracy", "value": None, "note": "each object is a class of its own"}]
    accuracy, chance, weights = np.array(outcomes).T
    return [
        {"split": "objects", "metric": "accuracy", "value": float(np.average(accuracy, weights=weights))},
        {"split": "objects", "metric": "chance", "value": float(np.average(chance, weights=weights))},
    ]


def majority_accuracy(labels: np.ndarray, train: np.ndarray, test: np.ndarray) -> float:
    """The test accuracy of always predicting the most common class of the training pictures."""
    names, counts = np.unique(labels[train], return_counts=True)
    return float((labels[test] == names[counts.argmax()]).mean())


def read_head(folder: Path, method: str, task: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(weights (k, C) f4, bias (k,) f4, class names (k,)) of a trained head."""
    arrays = read_arrays(folder / "heads" / method / f"{task}.npz")
    return arrays["weights"], arrays["bias"], arrays["classes"]
