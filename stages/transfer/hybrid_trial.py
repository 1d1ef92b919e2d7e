"""One hybrid network: two trainings, the stitching, and the tests with one sense, both, and damaged ones (T5.5)."""

import itertools
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple, Self

import numpy as np
import torch

from haptic_glance.base.files import read_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep.device import choose_device, device_of, explain_out_of_memory
from haptic_glance.deep.hybrid import SENSES, HybridNet
from haptic_glance.deep.images import augmentation
from haptic_glance.deep.modes import finetuned_except, frozen_modules
from haptic_glance.deep.network import Network, build
from haptic_glance.deep.pictures import as_images, picture_augmentation
from haptic_glance.deep.training import train_model
from haptic_glance.deep.weights import available_weights
from stages.kit.repeatable import repeatable
from stages.kit.stats import interval_metrics

from . import fusion
from .hybrid_both import fused_rows
from .hybrid_compared import comparison_rows, onnx_rows
from .hybrid_data import SenseData, read_pictures
from .hybrid_scores import sense_scores
from .middle import middle_of
from .new_object import TOUCH, new_object_rows
from .schema import Params
from .split import by_objects, by_touches, stratified_split
from .touches import Touches, read_touches, sensor_arrays

PAIR_METRICS = ("max_difference", "size_ratio")  # metrics of the summary of both senses together


class HybridTrial(NamedTuple):
    """The settings of one hybrid network; its name is hybrid.LAYERS.SPLIT.REPETITION, with - for the colon."""

    layers: str
    split: str
    repetition: int

    @property
    def name(self) -> str:
        return ".".join(map(str, ("hybrid", *self))).replace(":", "-")

    @classmethod
    def parse(cls, name: str) -> Self:
        """The trial with this name."""
        _, layers, split, repetition = name.split(".")
        return cls(layers.replace("-", ":"), split, int(repetition))


def trials(settings: Params, members: Mapping[str, Mapping[str, Sequence[str]]]) -> list[str]:
    """The names of all hybrid networks, as many of each middle as splits. members: {split: {class: its objects}}."""
    return [
        HybridTrial(layers, split, number).name
        for layers, (split, count) in itertools.product(settings.hybrid_middles, settings.splits.items())
        if len(members[split]) > 1
        for number in range(count)
    ]


@explain_out_of_memory()
def process(
    name: str, folder: Path, made: Path, members: Mapping[str, Mapping[str, Sequence[str]]], settings: Params, seed: int
) -> list[dict]:
    """Trains two networks with their middle frozen, stitches them and tests the result; returns the rows.

    made: the folder of the touches and pictures; members: {split: {class: its objects}}. Writes below folder/hybrid:
    predictions/NAME.npz (the scores of both senses for their test items), networks/NAME.npz (the hybrid network; of the
    first repetition) and, of the first repetition of the first middle on touches drawn at random, NAME.onnx. The
    training settings are those of the stage; `validation_share` of the training items is kept for the temperatures.
    """
    trial = HybridTrial.parse(name)
    first = trial.layers == settings.hybrid_middles[0]
    random = rng(seed, f"hybrid {trial.split} {trial.repetition}")
    senses = [
        split_sense(sense, trial, settings, random) for sense in read_senses(made, members[trial.split], settings)
    ]
    classes = list(members[trial.split])
    with repeatable(int(random.integers(2**31))):
        trained = [
            train_sense(sense, kind, trial, len(classes), settings, random, folder / f"{kind}.pt")
            for kind, sense in zip(SENSES, senses, strict=True)
        ]
        networks, seconds = [one[0] for one in trained], [one[1] for one in trained]
        hybrid = HybridNet(networks[0], networks[1], middle_of(trial.layers))
        alone = [sense_scores(hybrid, sense.images[sense.validation], kind) for kind, sense in enumerate(senses)]
        pairs = zip(alone, senses, strict=True)
        found = [fit_temperature(scores, sense.labels[sense.validation]) for scores, sense in pairs]
        hybrid.temperature.copy_(torch.tensor(found))
        rows = [*comparison_rows(hybrid, networks, senses, seconds, name, folder, classes)]
        rows += confusion_rows(folder / "hybrid" / "predictions" / f"{name}.npz", classes)
        if first:
            rows += fused_rows(hybrid, senses, settings, rng(seed, f"pairs {trial.split} {trial.repetition}"), seed)
        if first and trial.split == "objects":
            imagenet = build("mobilenet_v2", len(classes), "imagenet", 0, settings.source).to(device_of(hybrid))
            names = object_names(members[trial.split])
            rows += new_object_rows(hybrid, imagenet, senses[TOUCH], names, settings.new_object_touches, random)
        if first and trial.repetition == 0 and trial.split == "random" and settings.hybrid_onnx:
            rows += onnx_rows(hybrid, senses, settings, folder / "hybrid" / f"{name}.onnx")
    if trial.repetition:
        (folder / "hybrid" / "networks" / f"{name}.npz").unlink()
    about = {
        "data": "hybrid",
        "weights": "imagenet",
        "pretrained": available_weights("mobilenet_v2", settings.source),
        "mode": trial.layers,
    }
    return [about | {"split": trial.split, "repetition": trial.repetition} | row for row in rows]


def object_names(members: Mapping[str, Sequence[str]]) -> dict[int, str]:
    """{number as in Touches.objects: name} of the objects of {class: its objects}."""
    most = max(map(len, members.values()))
    return {label * most + rank: name for label, own in enumerate(members.values()) for rank, name in enumerate(own)}


def fit_temperature(scores: np.ndarray, labels: np.ndarray) -> float:
    """The best temperature for the items with a prediction, which a touch without contact does not have."""
    answered = np.isfinite(scores).all(axis=1)
    return fusion.best_temperature(scores[answered], labels[answered])


def read_senses(folder: Path, members: Mapping[str, Sequence[str]], settings: Params) -> tuple[Touches, Touches]:
    """(pictures, touches) of the objects, both as Touches."""
    return read_pictures(folder, members), read_touches(folder, members, next(iter(sensor_arrays(settings))))


def split_sense(items: Touches, trial: HybridTrial, settings: Params, random: np.random.Generator) -> SenseData:
    """The SenseData of touches, or of pictures as Touches."""
    if trial.split == "objects":
        split = by_objects(items.labels, items.ranks, trial.repetition, settings.validation_share, random)
    else:
        split = by_touches(items.objects, settings.train_share, settings.validation_share, random)
    # Not the split's own validation part, one object per class: of three objects one would be left for training.
    kept, rest = stratified_split(items.objects[split.train], settings.validation_share, random)
    images = as_images(items.images, settings.size)
    ids = split.train[rest], split.train[kept], split.test
    return SenseData(items.images, images, items.labels, items.objects, *ids)


def train_sense(
    sense: SenseData,
    kind: str,
    trial: HybridTrial,
    classes: int,
    settings: Params,
    random: np.random.Generator,
    checkpoint: Path,
) -> tuple[Network, float]:
    """(network, seconds): a MobileNetV2 trained on one sense with the trial's layers frozen at ImageNet's weights."""
    first_weights, seed = (int(number) for number in random.integers(2**31, size=2))
    device = choose_device(settings.device)
    with Stopwatch() as watch:
        network = build("mobilenet_v2", classes, "imagenet", first_weights, settings.source).to(device)
        augment = picture_augmentation() if kind == "vision" else augmentation()
        task = finetuned_except(network, sense.images.to(device), augment, tuple(frozen_modules(trial.layers, network)))
        model = train_model(
            task, sense.labels, sense.train, settings.hybrid_rate, settings.epochs, settings.batch, settings.momentum,
            seed=seed, checkpoint=checkpoint,
        )  # fmt: skip
    assert isinstance(model, Network)
    return model, watch.seconds


def summary(rows: list[dict], settings: Params, seed: int) -> dict[str, dict]:
    """{split: {accuracy_vision, accuracy_touch, max_difference, size_ratio}} of the hybrid network of the first middle.

    Each with its interval over the repetitions, where there are several.
    """
    values, tree = defaultdict(list), {}
    for row in rows:
        if row["method"] == "hybrid" and row["mode"] == settings.hybrid_middles[0]:
            name = row["metric"] if row["metric"] in PAIR_METRICS else f"{row['metric']}_{row['sense']}"
            values[row["split"], name].append(row["value"])
    for (split, name), found in values.items():
        if name in (*PAIR_METRICS, *(f"accuracy_{sense}" for sense in SENSES)):
            tree.setdefault(split, {})[name] = interval_metrics(found, seed)
    return tree


def confusion_rows(predictions: Path, classes: Sequence[str]) -> list[dict]:
    """Rows of the confusion matrix of each sense (T figure 5.6): how many items of `group` were taken for `predicted`.

    A touch without contact has no prediction and is not counted.
    """
    stored, rows = read_arrays(predictions), []
    for sense in SENSES:
        scores, counts = stored[f"{sense}_scores"], np.zeros((len(classes), len(classes)), dtype=int)
        answered = np.isfinite(scores).all(axis=1)
        np.add.at(counts, (stored[f"{sense}_true"][answered], scores[answered].argmax(axis=1)), 1)
        about = {"method": "hybrid", "sense": sense, "metric": "confusion"}
        rows += [
            about | {"group": classes[i], "predicted": classes[j], "value": int(counts[i, j])}
            for i, j in np.argwhere(counts)
        ]
    return rows
