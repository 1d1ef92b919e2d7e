"""One hybrid network: two trainings, the stitching, and what it does with one sense, both, and broken ones (T5.5)."""

import itertools
from collections import defaultdict
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pandas as pd
import torch

from stages.kit import Stopwatch
from stages.kit.files import read_arrays
from stages.kit.repeatable import repeatable
from stages.kit.rng import rng
from stages.kit.stats import interval_metrics
from stages.networks.device import choose, enough_memory
from stages.networks.images import augmentation
from stages.networks.layers import frozen_modules
from stages.networks.modes import all_but
from stages.networks.network import build
from stages.networks.training import learn
from stages.networks.weights import had

from . import fusion
from .hybrid import SENSES, HybridNet
from .hybrid_both import fused
from .hybrid_compared import compared, exported
from .hybrid_data import as_images, read_pictures
from .hybrid_scores import scored
from .middle import middle_of
from .pictures import picture_augmentation
from .split import by_objects, by_touches, stratified_split
from .touches import arrays, read_touches
from .trial import UNFINISHED

WHOLE = ("max_difference", "size_ratio")  # metrics of the summary that are not of one sense


class Trial(NamedTuple):
    """What one hybrid network is; its name is hybrid.LAYERS.SPLIT.REPETITION, the range with - for its colon."""

    layers: str
    split: str
    repetition: int

    @property
    def name(self):
        return ".".join(map(str, ("hybrid", *self))).replace(":", "-")

    @classmethod
    def parse(cls, name):
        """The trial of a name."""
        _, layers, split, repetition = name.split(".")
        return cls(layers.replace("-", ":"), split, int(repetition))


@dataclass(frozen=True, eq=False)
class Sense:
    """What one sense took of all objects, in parts: images (k, 3, h, w) f4 in 0..1, labels and objects (k,) i8."""

    raw: np.ndarray
    images: torch.Tensor
    labels: np.ndarray
    objects: np.ndarray
    train: np.ndarray
    check: np.ndarray
    test: np.ndarray


def trials(settings, members):
    """The names of all hybrid networks. members: {split: {class: its objects}}.

    None where hybrid_repetitions is 0.
    """
    splits = [split for split in settings.splits if len(members[split]) > 1]
    every = itertools.product(settings.hybrid_middles, splits, range(settings.hybrid_repetitions))
    return [Trial(*one).name for one in every]


@enough_memory()
def process(name, folder, members, settings, seed):
    """Trains two networks with their middle frozen, stitches them and tests all; returns the rows.

    members: {split: {class: its objects}}. Writes below folder/hybrid: predictions/NAME.npz (the scores of both senses
    for their test items), networks/NAME.npz (the hybrid network; of the first repetition) and, of the first repetition
    of the first middle on touches drawn at random, NAME.onnx. What the networks learned from is what settings of the
    whole stage say; of the part for training `validation_share` is kept for the temperatures.
    """
    trial = Trial.parse(name)
    first = trial.layers == settings.hybrid_middles[0]
    random = rng(seed, f"hybrid {trial.split} {trial.repetition}")
    senses = [divided(sense, trial, settings, random) for sense in read(folder, members[trial.split], settings)]
    classes = list(members[trial.split])
    with repeatable(int(random.integers(2**31))):
        trained = [
            training(sense, kind, trial, len(classes), settings, random, folder / UNFINISHED / name)
            for kind, sense in zip(SENSES, senses, strict=True)
        ]
        networks, seconds = [one[0] for one in trained], [one[1] for one in trained]
        hybrid = HybridNet(*networks, middle_of(trial.layers))
        alone = [scored(hybrid, sense.images[sense.check], kind) for kind, sense in enumerate(senses)]
        pairs = zip(alone, senses, strict=True)
        found = [spoken_temperature(scores, sense.labels[sense.check]) for scores, sense in pairs]
        hybrid.temperature.copy_(torch.tensor(found))
        rows = [*compared(hybrid, networks, senses, seconds, name, folder, classes)]
        if first:
            rows += fused(hybrid, senses, settings, rng(seed, f"pairs {trial.split} {trial.repetition}"), seed)
        if first and trial.repetition == 0 and trial.split == "random" and settings.hybrid_onnx:
            rows += exported(hybrid, senses, settings, folder / "hybrid" / f"{name}.onnx")
    if trial.repetition:
        (folder / "hybrid" / "networks" / f"{name}.npz").unlink()
    about = {"data": "hybrid", "weights": "imagenet", "had": had("mobilenet_v2", settings.source), "mode": trial.layers}
    return [about | {"split": trial.split, "repetition": trial.repetition} | row for row in rows]


def spoken_temperature(scores, labels):
    """The best temperature of the items that a sense said something about: a touch that felt nothing is none."""
    spoken = np.isfinite(scores).all(axis=1)
    return fusion.best_temperature(scores[spoken], labels[spoken])


def read(folder, members, settings):
    """(pictures, touches) of the objects, as Touches."""
    return read_pictures(folder, members), read_touches(folder, members, next(iter(arrays(settings))))


def divided(items, trial, settings, random):
    """The Sense of Touches, or of pictures in their place."""
    if trial.split == "objects":
        split = by_objects(items.labels, items.ranks, trial.repetition, settings.validation_share, random)
    else:
        split = by_touches(items.objects, settings.train_share, settings.validation_share, random)
    # Not the split's own check, a whole object of each class: of three objects one would be left to learn from.
    kept, rest = stratified_split(items.objects[split.train], settings.validation_share, random)
    images = as_images(items.images, settings.size)
    ids = split.train[rest], split.train[kept], split.test
    return Sense(items.images, images, items.labels, items.objects, *ids)


def training(sense, kind, trial, classes, settings, random, kept):
    """(network, seconds): a MobileNetV2 that learned one sense with the trial's layers frozen at ImageNet's."""
    first_weights, seed = (int(number) for number in random.integers(2**31, size=2))
    device = choose(settings.device)
    with Stopwatch() as watch:
        network = build("mobilenet_v2", classes, "imagenet", first_weights, settings.source).to(device)
        moved = picture_augmentation() if kind == "vision" else augmentation()
        task = all_but(network, sense.images.to(device), moved, tuple(frozen_modules(trial.layers, network)))
        model = learn(
            task, sense.labels, sense.train, settings.hybrid_rate, settings.epochs, settings.batch, settings.momentum,
            seed=seed, checkpoint=kept.with_name(f"{kept.name}.{kind}.pt"),
        )  # fmt: skip
    return model, watch.seconds


def summary(rows, settings, seed):
    """{split: {accuracy_vision, accuracy_touch, max_difference, size_ratio}} of the hybrid network of the first middle.

    Each with its interval over the repetitions, where there are several.
    """
    values, tree = defaultdict(list), {}
    for row in rows:
        if row["method"] == "hybrid" and row["mode"] == settings.hybrid_middles[0]:
            name = row["metric"] if row["metric"] in WHOLE else f"{row['metric']}_{row['sense']}"
            values[row["split"], name].append(row["value"])
    for (split, name), found in values.items():
        if name in (*WHOLE, *(f"accuracy_{sense}" for sense in SENSES)):
            tree.setdefault(split, {})[name] = interval_metrics(found, seed)
    return tree


def confusion(folder, names, members):
    """Tidy frame of the confusion matrices (T figure 5.6): trial, sense, true class, predicted class, count.

    A touch that felt nothing has no answer, and is in none of the cells.
    """
    rows = []
    for name in names:
        classes = list(members[Trial.parse(name).split])
        stored = read_arrays(folder / "hybrid" / "predictions" / f"{name}.npz")
        for sense in SENSES:
            scores, counts = stored[f"{sense}_scores"], np.zeros((len(classes), len(classes)), dtype=int)
            spoken = np.isfinite(scores).all(axis=1)
            np.add.at(counts, (stored[f"{sense}_true"][spoken], scores[spoken].argmax(axis=1)), 1)
            rows += [
                {"trial": name, "sense": sense, "true": classes[i], "predicted": classes[j], "count": counts[i, j]}
                for i, j in np.ndindex(counts.shape)
            ]
    return pd.DataFrame(rows)
