"""Recorded touches as data for networks: readers by name, tasks, parts, and the classifier of T4 on the same splits.

The trained part of a network is its head alone on cached features, or all its layers. Parts say which touches train,
which choose the learning rate, and which test.
"""

import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from threadpoolctl import threadpool_limits

from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep.device import choose_device
from haptic_glance.deep.images import augmentation, normalise, to_images
from haptic_glance.deep.modes import Task
from haptic_glance.deep.network import Network, build, recalibrate
from haptic_glance.know import classifier
from haptic_glance.know.split import Split
from stages.classification.touch_readers import read_grasps, read_pressure_images
from stages.recorded.biotac_grasps import Model, publisher_split_rows, recognition_rows
from stages.recorded.pressure_images import describe
from stages.recorded.splits import SPLITS, split_number
from stages.transfer.recorded_images import (
    Recorded,
    grasp_images,
    pressure_images,
    read_bigs,
    read_vitac,
    read_vt60,
)

from . import Params


@dataclass(frozen=True)
class Recording:
    """Recorded touches, how they are split, and whether training may reflect, move and scale their images.

    test_objects: names of the objects that the publisher keeps for testing.
    """

    touches: Recorded
    splits: tuple[Split, ...]
    augmented: bool
    test_objects: tuple[str, ...] = ()


BY_OBJECT = Split.RANDOM, Split.OBJECTS


def _pressure(path: Path) -> dict[str, Recording]:
    touches = pressure_images(read_pressure_images(path))
    return {"pressure": Recording(touches, (Split.RANDOM, Split.BLOCKS), True)}


def _grasps(path: Path) -> dict[str, Recording]:
    # A reflected fingertip is another finger's and a moved one none, so grasps are not augmented.
    grasps = read_grasps(path)
    test_names = tuple(np.unique(grasps.objects[grasps.test]).tolist())
    return {
        "grasps_object": Recording(grasp_images(grasps, "objects"), (Split.RANDOM, Split.BLOCKS), False),
        "grasps_slip": Recording(grasp_images(grasps, "slipped"), (Split.TEST_OBJECTS,), False, test_names),
    }


def _bigs(path: Path) -> dict[str, Recording]:
    kinds = {"bigs": read_bigs(path), "bigs_instant": read_bigs(path, instant=True)}
    return {name: Recording(touches, BY_OBJECT, False) for name, touches in kinds.items()}


# {kind of recording: reader of {what is recognised: Recording}}
SOURCES: dict[str, Callable[[Path], dict[str, Recording]]] = {
    "pressure_images": _pressure, "biotac_grasps": _grasps, "bigs": _bigs,
    "vitac": lambda path: {"vitac": Recording(read_vitac(path), BY_OBJECT, True)},
    "vt60": lambda path: {"vt60": Recording(read_vt60(path), BY_OBJECT, True)},
}  # fmt: skip


SOME = 512  # images, at most, that an untrained network's normalisation takes its statistics from


def as_images(images: np.ndarray, size: int) -> torch.Tensor:
    """(k, 3, size, size) in 0..1 of images (k, r, c) or (k, r, c, 3) u1: grey in the red channel alone (T5.3)."""
    if images.ndim == 3:
        return to_images(images, size)
    return torch.stack([to_images(images[..., k], size)[:, 0] for k in range(3)], dim=1)


def frozen(features: torch.Tensor, classes: int, train: np.ndarray, method: str, seed: int) -> tuple[Network, Task]:
    """The head alone on cached features (1 + copies, k, width), scaled by mean and deviation over the training part.

    The scale is the same for all networks, so that one set of learning rates serves them: an untrained network's
    features differ from image to image by a hundredth of their size, and its head would learn nothing in the time.
    """
    network = build(method, classes, "random", seed)
    plain = features[0, train]
    spread = plain.std(dim=0)
    scaled = (features - plain.mean(dim=0)) / torch.where(spread > 1e-6 * spread.max(), spread, 1)

    def drawn(ids):
        return scaled[torch.randint(len(scaled), (len(ids),)), ids]

    return network, _task(network.head, drawn, lambda ids: scaled[0, ids], lambda head, ids: None)


def finetuned(
    recording: Recording, train: np.ndarray, method: str, weights: str, seed: int, settings: Params
) -> tuple[Network, Task]:
    """All layers, on images augmented anew at every step where that makes sense."""
    device, augment = choose_device(settings.device), augmentation()
    images = as_images(recording.touches.images, settings.size).to(device)
    network = build(method, len(recording.touches.classes), weights, seed, settings.source).to(device)
    network.requires_grad_(True)

    def inputs(ids):
        return normalise(images[ids])

    def drawn(ids):
        return normalise(augment(images[ids])) if recording.augmented else inputs(ids)

    if weights == "random":
        recalibrate(network, inputs, train)
    return network, _task(network, drawn, inputs, lambda model, ids: recalibrate(model, inputs, ids))


@torch.no_grad()
def frozen_features(
    recording: Recording, method: str, weights: str, draw: int, settings: Params, sample: np.ndarray
) -> torch.Tensor:
    """(1 + copies, k, width) f4: the frozen network's features of all images, plain first, then augmented.

    An untrained network is drawn by the method's name and the number of the draw. If sample (n,), ids of images that
    train, is not empty, the normalisation of a `random` network has the statistics of some of these images.
    """
    device, augment = choose_device(settings.device), augmentation()
    network = build(method, 2, weights, zlib.crc32(f"{method} {draw}".encode()), settings.source).to(device)

    def inputs(ids, change=lambda images: images):
        return normalise(change(as_images(recording.touches.images[ids.numpy()], settings.size).to(device)))

    ids = torch.arange(len(recording.touches.images))
    if weights == "random" and len(sample):
        recalibrate(network, inputs, sample[:: max(1, len(sample) // SOME)])
    changes = [{}] + [{"change": augment}] * (settings.copies if recording.augmented else 0)
    return torch.stack(
        [torch.cat([network.features(inputs(part, **options)).cpu() for part in ids.split(32)]) for options in changes]
    )


def _task(model: torch.nn.Module, augmented: Callable, inputs: Callable, finish: Callable) -> Task:
    return Task(model=model, training_inputs=augmented, inputs=inputs, finish=finish, encode=normalise)


QUARTER = 0.25  # of the objects or recordings, held out; as many as of the touches (T5.3)


def parts(recording: Recording, split: str, number: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(train, validation, test): ids of a split; validation is cut from the training part in the same way.

    random: a random quarter of each class; blocks: of each class a run of neighbours, a quarter of it; objects: a
    quarter of the objects or recordings; test_objects: those that the publisher keeps, validation a quarter of the
    other objects. Raises ValueError where a class has one object or recording alone.
    """
    if split == Split.TEST_OBJECTS:
        in_test = np.isin(groups_of(recording), recording.test_objects)
        train, test, inner = np.flatnonzero(~in_test), np.flatnonzero(in_test), str(Split.OBJECTS)
    else:
        inner = split
        train, test = _cut(recording, np.arange(len(recording.touches.labels)), split, number)
    fit, validation = _cut(recording, train, inner, number)
    return fit, validation, test


def object_split(labels: np.ndarray, groups: np.ndarray, number: int) -> tuple[np.ndarray, np.ndarray]:
    """(train, test): a quarter of the groups of each class, one at least, all its touches in the test.

    A group with touches of several classes counts for the lowest of them. Raises ValueError where too few are left.
    """
    random, test_groups = np.random.default_rng(number), []
    names = np.unique(groups)
    lowest = np.array([labels[groups == name].min() for name in names])
    for label in np.unique(lowest):
        members = names[lowest == label]
        test_groups.append(random.choice(members, max(1, round(QUARTER * len(members))), replace=False))
    in_test = np.isin(groups, np.concatenate(test_groups))
    for part in (in_test, ~in_test):
        if missing := set(labels) - set(labels[part]):
            raise ValueError(f"class {min(missing)} has too few groups to hold one out")
    return np.flatnonzero(~in_test), np.flatnonzero(in_test)


def groups_of(recording: Recording) -> np.ndarray:
    """(k,) names of the object or recording of each touch; ValueError where nobody knows them."""
    if recording.touches.groups is None:
        raise ValueError("these recordings do not say which object a touch is of: no object can be held out")
    return recording.touches.groups


def _cut(recording: Recording, ids: np.ndarray, split: str, number: int) -> tuple[np.ndarray, np.ndarray]:
    labels = recording.touches.labels[ids]
    if split == Split.OBJECTS:
        first, second = object_split(labels, groups_of(recording)[ids], number)
    else:
        first, second = SPLITS[Split(split)](labels, number)
    return ids[first], ids[second]


METHOD = "features_knn"  # the hand-made features of T4, or the electrodes, and the k nearest neighbours
COLUMNS = ("item", "data", "split", "repetition", "metric", "value", "seconds")


def neighbour_rows(kind: str, path: Path, repetitions: int, seed: int) -> list[dict]:
    """Rows of the classifier on a kind of recording, split as in stage `recorded`; none for a kind of cameras."""
    if kind not in READERS:
        return []
    with threadpool_limits(1):  # equal sums on any number of cores
        rows = list(READERS[kind](path, repetitions, seed))
    return [{"method": METHOD, "metric": "accuracy"} | {key: row[key] for key in COLUMNS if key in row} for row in rows]


def _neighbours_pressure(path: Path, repetitions: int, seed: int) -> Iterator[dict]:
    touches = describe(read_pressure_images(path))
    for split, draw in SPLITS.items():
        for repetition in range(repetitions):
            number = split_number(seed, repetition)
            train, test = draw(touches.labels, number)
            with Stopwatch() as watch:
                model = classifier("knn", number).fit(touches.samples[train], touches.labels[train])
                answers = model.predict(touches.samples[test])
            row = {"data": "pressure", "split": split, "repetition": repetition, "seconds": watch.seconds}
            yield row | {"value": float((answers == touches.labels[test]).mean())}


def _neighbours_grasps(path: Path, repetitions: int, seed: int) -> Iterator[dict]:
    grasps, model = read_grasps(path), Model("knn", None)
    yield from ({"data": "grasps_object"} | row for row in recognition_rows(model, grasps, repetitions, seed))
    slips = [row for row in publisher_split_rows(model, grasps) if row["palm"] == "all"]
    common = {"data": "grasps_slip", "repetition": 0}
    yield from (row | common for row in slips)
    mean = np.average([row["value"] for row in slips], weights=[row["count"] for row in slips])
    yield common | {"split": slips[0]["split"], "value": float(mean)}


READERS: dict[str, Callable[[Path, int, int], Iterator[dict]]] = {
    "pressure_images": _neighbours_pressure, "biotac_grasps": _neighbours_grasps,
}  # fmt: skip
