"""Modes `last_block` and `finetuned`: one network per task, of which more than a new head is trained (T3.3.3)."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import torch

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep import build, normalise, recalibrate, search_rate, train_model
from haptic_glance.deep.cam import grad_cam
from haptic_glance.deep.device import choose_device, device_of, explain_out_of_memory, mixed_precision
from haptic_glance.deep.modes import Task
from haptic_glance.deep.network import Network
from stages.kit.repeatable import repeatable

from .backbone import BATCH
from .heads import majority_accuracy
from .options import MODES, Method
from .pictures import augmentation, network_inputs, read_pictures, to_images
from .schema import Params
from .split import random_views
from .trunk import cached_task, read_trunk

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
    task = max(tasks, key=lambda one: len(set(tasks[one].values())))
    labels = labels_of(objects, tasks[task], settings)
    part, validation, _ = divided(labels, seed)
    with repeatable(seed), Stopwatch() as watch:
        given = {"epochs": 1, "batch": settings.batch, "momentum": settings.momentum, "seed": seed}
        lesson, _, _ = lesson_of(made, method, settings, objects, labels.max() + 1, seed)
        rate, accuracy = search_rate(lesson, labels, part, validation, settings.rates, **given)
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
    fixed, so that the validation views are not used.
    """
    labels = labels_of(objects, tasks[task], settings)
    part, _, test = divided(labels, seed)
    stored = read_arrays(made / ".rates" / f"{method.name}.npz") if method.mode == OF_LAST_BLOCK else {}
    options = {name: getattr(settings, name) for name in ("epochs", "batch", "momentum")}
    options["rate"] = float(stored.get("rate", settings.rate))
    with repeatable(seed), Stopwatch() as training:
        lesson, trunk, copies = lesson_of(made, method, settings, objects, labels.max() + 1, seed)
        model = train_model(lesson, labels, part, **options, checkpoint=folder / "training.pt")
    with repeatable(seed), Stopwatch() as looking:
        cams, found = look(model, lesson, len(labels))
    seconds = (looking.seconds + trunk / len(tasks)) / len(objects)
    cams = cams.reshape(len(objects), -1, *cams.shape[1:])
    write_arrays(folder / ".cams" / method.name / f"{task}.npz", cams=cams, objects=np.array(objects), seconds=seconds)
    paid = training.seconds + (copies + float(stored.get("seconds", 0))) / len(tasks)
    row = {"method": method.name, "task": task, "split": "views"}
    return [
        row | {"metric": "accuracy", "value": float((found[test] == labels[test]).mean()), "seconds": paid},
        row | {"metric": "chance", "value": majority_accuracy(labels, part, test)},
    ]


def labels_of(objects: Sequence[str], known: Mapping[str, str], settings: Params) -> np.ndarray:
    """(n,) i8: the number of the class of each picture of the objects, -1 for an object without one."""
    names, views = sorted(set(known.values())), settings.parallels * settings.azimuths + 2
    return np.repeat([names.index(known[name]) if name in known else -1 for name in objects], views)


def divided(labels: np.ndarray, seed: int) -> list[np.ndarray]:
    """[train, validation, test]: ids of the pictures with a class."""
    own = np.flatnonzero(labels >= 0)
    return [own[ids] for ids in random_views(len(own), rng(seed, "fixation views"))]


def lesson_of(
    made: Path, method: Method, settings: Params, objects: Sequence[str], classes: int, seed: int
) -> tuple[Task, float, float]:
    """(the Task of a method, seconds of its trunk for the pictures, and for their augmented copies)."""
    own = method.mode == OF_LAST_BLOCK
    network = build(method.network, classes, MODES[method.mode], seed, settings.source, fully_connected=own)
    network = network.to(choose_device(settings.device))
    if own:
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
    found = []
    for ids in torch.arange(count).split(BATCH):
        with explain_out_of_memory(), mixed_precision(device_of(model)):
            found.append(grad_cam(model.convolutions(lesson.inputs(ids)), model.classify))
    cams, classes = zip(*found, strict=True)
    return np.concatenate(cams), np.concatenate(classes)


def read_cams(made: Path, method: str, name: str, tasks: Sequence[str]) -> tuple[dict[str, np.ndarray], float]:
    """(dict task -> (v, i, j) f4 Grad-CAM maps of one object, seconds of its networks)."""
    found, seconds = {}, 0.0
    for task in tasks:
        stored = read_arrays(made / ".cams" / method / f"{task}.npz")
        found[task] = stored["cams"][stored["objects"].tolist().index(name)]
        seconds += float(stored["seconds"])
    return found, seconds
