"""Trials of the hybrid network (T5.5): two trainings, the stitching, and tests with one sense, both, and damaged ones.

The hybrid network is compared with its two parent networks: accuracy, size, and as ONNX.
"""

import itertools
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple, Self

import numpy as np
import torch

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep.device import choose_device, device_of, explain_out_of_memory, repeatable
from haptic_glance.deep.hybrid import PRECISIONS, SENSES, HybridNet, load, save, state_arrays
from haptic_glance.deep.images import augmentation, normalise
from haptic_glance.deep.modes import finetuned_except, frozen_modules
from haptic_glance.deep.network import Network, build, count_parameters
from haptic_glance.deep.rendered_views import as_images
from haptic_glance.deep.training import CONVERGED, Learning, accuracy, predict_probabilities, train_model
from haptic_glance.deep.weights import available_weights
from stages.engine.statistics import interval_metrics, stratified_split

from . import Params, fusion
from .hybrid_data import SenseData, fused_rows, in_batches, read_pictures, row, sense_scores, single_sense
from .imprint_images import Touches, read_touches, sensor_arrays
from .new_object import TOUCH, new_object_rows
from .onnx_export import export_onnx, onnx_scores
from .plan import by_objects, by_touches, middle_of

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
        networks, seconds = [training.network for training in trained], [training.seconds for training in trained]
        hybrid = HybridNet(networks[0], networks[1], middle_of(trial.layers))
        alone = [sense_scores(hybrid, sense.images[sense.validation], kind) for kind, sense in enumerate(senses)]
        pairs = zip(alone, senses, strict=True)
        temperatures = [fit_temperature(scores, sense.labels[sense.validation]) for scores, sense in pairs]
        hybrid.temperature.copy_(torch.tensor(temperatures))
        rows = [*comparison_rows(hybrid, networks, senses, seconds, name, folder, classes)]
        rows += [
            row(SENSES[kind], metric, getattr(training, metric), kind)
            for kind, training in enumerate(trained)
            for metric in ("train_accuracy", "epochs")
        ]
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
    columns = {
        "data": "hybrid",
        "weights": "imagenet",
        "pretrained": available_weights("mobilenet_v2", settings.source),
        "mode": trial.layers,
        "passes": settings.hybrid_passes,
    }
    return [columns | {"split": trial.split, "repetition": trial.repetition} | row for row in rows]


def object_names(members: Mapping[str, Sequence[str]]) -> dict[int, str]:
    """{number as in Touches.objects: name} of the objects of {class: its objects}."""
    most = max(map(len, members.values()))
    return {
        label * most + rank: name for label, names in enumerate(members.values()) for rank, name in enumerate(names)
    }


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
    validation, remaining = stratified_split(items.objects[split.train], settings.validation_share, random)
    images = as_images(items.images, settings.size)
    ids = split.train[remaining], split.train[validation], split.test
    return SenseData(items.images, images, items.labels, items.objects, *ids)


class Training(NamedTuple):
    """A network trained on one sense, with its accuracy on the items that it learned and the number of its passes."""

    network: Network
    seconds: float
    train_accuracy: float
    epochs: int


def train_sense(
    sense: SenseData,
    kind: str,
    trial: HybridTrial,
    classes: int,
    settings: Params,
    random: np.random.Generator,
    checkpoint: Path,
) -> Training:
    """A MobileNetV2 trained on one sense with the trial's layers frozen at ImageNet's weights.

    Where settings.hybrid_passes is `converged`, the validation items end the training and choose its weights, as T5.3
    trains networks. Raises Diverged where the loss is not finite.
    """
    first_weights, seed = (int(number) for number in random.integers(2**31, size=2))
    device, converged = choose_device(settings.device), settings.hybrid_passes == CONVERGED
    learning = Learning(sense.validation if converged else None, settings.patience)
    most = settings.most_epochs if converged else settings.epochs
    with Stopwatch() as watch:
        network = build("mobilenet_v2", classes, "imagenet", first_weights, settings.source).to(device)
        augment = augmentation(upright=kind == "vision")
        task = finetuned_except(network, sense.images.to(device), augment, tuple(frozen_modules(trial.layers, network)))
        model = train_model(
            task, sense.labels, sense.train, settings.hybrid_rate, most, settings.batch, settings.momentum,
            seed=seed, checkpoint=checkpoint, learning=learning,
        )  # fmt: skip
    assert isinstance(model, Network)
    learned = accuracy(predict_probabilities(model, task.inputs, sense.train), sense.labels[sense.train])
    return Training(model, watch.seconds, learned, len(learning.curve))


def summary(rows: list[dict], settings: Params, seed: int) -> dict[str, dict]:
    """{split: {accuracy_vision, accuracy_touch, max_difference, size_ratio}} of the hybrid network of the first middle.

    Each with its interval over the repetitions, where there are several.
    """
    values, tree = defaultdict(list), {}
    for entry in rows:
        if entry["method"] == "hybrid" and entry["mode"] == settings.hybrid_middles[0]:
            name = entry["metric"] if entry["metric"] in PAIR_METRICS else f"{entry['metric']}_{entry['sense']}"
            values[entry["split"], name].append(entry["value"])
    for (split, name), numbers in values.items():
        if name in (*PAIR_METRICS, *(f"accuracy_{sense}" for sense in SENSES)):
            tree.setdefault(split, {})[name] = interval_metrics(numbers, seed)
    return tree


def confusion_rows(predictions: Path, classes: Sequence[str]) -> list[dict]:
    """Rows of the confusion matrix of each sense (T figure 5.6): how many items of `group` were taken for `predicted`.

    A touch without contact has no prediction and is not counted.
    """
    arrays, rows = read_arrays(predictions), []
    for sense in SENSES:
        scores, counts = arrays[f"{sense}_scores"], np.zeros((len(classes), len(classes)), dtype=int)
        answered = np.isfinite(scores).all(axis=1)
        np.add.at(counts, (arrays[f"{sense}_true"][answered], scores[answered].argmax(axis=1)), 1)
        columns = {"method": "hybrid", "sense": sense, "metric": "confusion"}
        rows += [
            columns | {"group": classes[i], "predicted": classes[j], "value": int(counts[i, j])}
            for i, j in np.argwhere(counts)
        ]
    return rows


def comparison_rows(
    hybrid: HybridNet,
    networks: Sequence[Network],
    senses: Sequence[SenseData],
    seconds: Sequence[float],
    name: str,
    folder: Path,
    classes: Sequence[str],
) -> Iterator[dict]:
    """Rows of the two networks, the hybrid and its versions of lower precision: accuracy and size."""
    paths = folder / "hybrid" / "networks"
    tested = {}
    for kind, (sense, network) in enumerate(zip(senses, networks, strict=True)):
        separate = in_batches(lambda part, n=network: n(normalise(part)), sense.images[sense.test], device_of(network))
        tested[kind] = sense_scores(hybrid, sense.images[sense.test], kind)
        write_arrays(paths / f"{name}.{kind}.npz", **state_arrays(network))
        yield row(SENSES[kind], "accuracy", fusion.accuracy(separate, sense.labels[sense.test]), kind, seconds[kind])
        yield row("hybrid", "max_difference", float(np.nanmax(np.abs(separate - tested[kind]))), kind)
    files = [paths / f"{name}.{kind}.npz" for kind in range(2)]
    separate_size = sum(path.stat().st_size for path in files)
    for kind, path in enumerate(files):
        yield row(SENSES[kind], "size_bytes", path.stat().st_size, kind)
        yield row(SENSES[kind], "parameters", count_parameters(networks[kind]), kind)
        path.unlink()
    yield row("hybrid", "parameters", count_parameters(hybrid))
    for number in reversed(PRECISIONS):  # float32 last, whose file is kept
        save(paths / f"{name}.npz", hybrid, classes, number)
        size = (paths / f"{name}.npz").stat().st_size
        method = "hybrid" if number == "float32" else f"hybrid_{number}"
        loaded = load(paths / f"{name}.npz")[0].to(device_of(hybrid))
        yield row(method, "size_bytes", size)
        yield row(method, "size_ratio", separate_size / size)
        for kind, sense in enumerate(senses):
            scores = sense_scores(loaded, sense.images[sense.test], kind)
            yield row(method, "accuracy", fusion.accuracy(scores, sense.labels[sense.test]), kind)
    write_arrays(
        folder / "hybrid" / "predictions" / f"{name}.npz",
        **{f"{kind}_scores": tested[place] for place, kind in enumerate(SENSES)},
        **{f"{kind}_true": sense.labels[sense.test] for kind, sense in zip(SENSES, senses, strict=True)},
        **{f"{kind}_test": sense.test for kind, sense in zip(SENSES, senses, strict=True)},
    )


def onnx_rows(hybrid: HybridNet, senses: Sequence[SenseData], settings: Params, path: Path) -> Iterator[dict]:
    """Rows of the network as ONNX over all test items: the largest difference of a score, and the agreement of classes.

    The difference is infinite where only one of them treats a sense as absent.
    """
    export_onnx(path, hybrid, settings.size)
    worst, agree = 0.0, []
    for kind, sense in enumerate(senses):
        scores = sense_scores(hybrid, sense.images[sense.test], kind)
        exported = onnx_scores(path, single_sense(sense.images[sense.test], kind))[kind]
        is_absent = np.isnan(scores)
        equal = np.array_equal(np.isnan(exported), is_absent)
        worst = max(worst, float(np.abs(exported - scores)[~is_absent].max(initial=0)) if equal else np.inf)
        agree += list(exported.argmax(axis=1) == scores.argmax(axis=1))
    yield row("hybrid_onnx", "max_difference", worst)
    yield row("hybrid_onnx", "agreement", float(np.mean(agree)))
    yield row("hybrid_onnx", "size_bytes", path.stat().st_size)
