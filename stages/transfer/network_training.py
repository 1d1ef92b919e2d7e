"""One training: data, network, initial weights, mode, split and repetition. An interrupted run repeats none of them."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import torch

from haptic_glance.base.files import read_json, write_arrays, write_json
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep.device import choose_device, explain_out_of_memory, repeatable
from haptic_glance.deep.images import normalise, to_images
from haptic_glance.deep.modes import Task, mode_named
from haptic_glance.deep.network import Network, build, count_parameters, recalibrate
from haptic_glance.deep.training import (
    CONVERGED,
    Diverged,
    Learning,
    accuracy,
    predict_probabilities,
    search_rate,
    train_model,
)
from stages.engine.statistics import Split

from . import Params
from .imprint_images import Touches, read_touches
from .onnx_export import network_parts, weight_changes
from .plan import PRINTED_RATE, Trial, by_objects, by_touches, printed_rate


@explain_out_of_memory()
def process(
    name: str, folder: Path, made: Path, members: Mapping[str, Mapping[str, Sequence[str]]], settings: Params, seed: int
) -> list[dict]:
    """Trains and tests one network; writes predictions/NAME.npz and, of the first repetition, networks/NAME.npz.

    made: the folder of the touches; members: {split: {class: its objects}}. The split, the head's initial weights and
    the random numbers of the training depend on split and repetition alone, so that weights, modes and arrays are
    compared on the same touches. A training that diverges gives one row with a note. Returns rows; `seconds` covers
    features, search and training, without the test.
    """
    trial = Trial.parse(name)
    touches = read_touches(made, members[trial.split], trial.data)
    random = rng(seed, f"transfer {trial.split} {trial.repetition}")
    split = split_touches(touches, trial, settings, random)
    first_weights, training_seed = (int(number) for number in random.integers(2**31, size=2))
    searched, checkpoint = folder / "rate.json", folder / "training.pt"  # an interrupted training goes on from these
    learning = Learning(split.validation if trial.passes == CONVERGED else None, settings.patience)
    learned = split.fit if trial.passes == CONVERGED else split.train
    with repeatable(training_seed):
        with Stopwatch() as watch:
            network, task = prepare(trial, touches, split.train, settings, first_weights)
            rate, validation_accuracy = learning_rate(
                task, touches.labels, split, trial, settings, training_seed, searched
            )
            most = settings.most_epochs if trial.passes == CONVERGED else settings.epochs
            training = _settings(settings, most, training_seed) | {"checkpoint": checkpoint, "learning": learning}
            try:
                model = train_model(task, touches.labels, learned, rate, **training)
            except Diverged as error:
                searched.unlink(missing_ok=True)
                return [{"trial": name, "metric": "accuracy", "value": None, "note": str(error)}]
        scores = predict_probabilities(model, task.inputs, split.test)
        rows = [*change_rows(network, model)] if task.model is network else []
        if learning.validation is not None:
            validation_accuracy = _accuracy_on(task, model, touches, split.validation)
        train_accuracy = _accuracy_on(task, model, touches, learned)
    truth = touches.labels[split.test]
    write_arrays(folder / "predictions" / f"{name}.npz", test=split.test, true=truth, scores=scores.numpy())
    if trial.repetition == 0:
        state = {key: np.ascontiguousarray(value.cpu().numpy()) for key, value in model.state_dict().items()}
        write_arrays(folder / "networks" / f"{name}.npz", **state)
    values = {
        "accuracy": accuracy(scores, truth),
        "train_accuracy": train_accuracy,
        "validation_accuracy": validation_accuracy,
        "chance": 1 / len(touches.classes),
        "learning_rate": rate,
        "epochs": len(learning.curve),
        "parameters": count_parameters(network),
        "trained_parameters": count_parameters(model, trained=True),
        "weight_change": float(np.mean([row["value"] for row in rows if "layer" in row] or [0.0])),
    }
    seconds = {"accuracy": watch.seconds}
    rows += [
        {"metric": key, "value": value, "seconds": seconds.get(key)}
        for key, value in values.items()
        if value is not None
    ]
    rows += object_rows(scores, touches, split.test, members[trial.split])
    rows += curve_rows(learning)
    searched.unlink(missing_ok=True)
    return [{"trial": name} | row for row in rows]


def object_rows(
    scores: torch.Tensor, touches: Touches, test: np.ndarray, members: Mapping[str, Sequence[str]]
) -> Iterator[dict]:
    """Rows of the accuracy on the test touches of each object."""
    for label, (group, objects) in enumerate(members.items()):
        for rank, item in enumerate(objects):
            mask = (touches.labels[test] == label) & (touches.ranks[test] == rank)
            if mask.any():
                value = accuracy(scores[torch.as_tensor(mask)], touches.labels[test][mask])
                yield {"item": item, "group": group, "metric": "object_accuracy", "value": value}


def curve_rows(learning: Learning) -> Iterator[dict]:
    """Rows of the curve of a training until nothing improves, pass by pass."""
    for number, values in enumerate(learning.curve if learning.validation is not None else [], start=1):
        for name in ("loss", "train_accuracy", "validation_accuracy"):
            yield {"epoch": number, "metric": f"curve_{name}", "value": values[name]}


def prepare(trial: Trial, touches: Touches, train: np.ndarray, settings: Params, seed: int) -> tuple[Network, Task]:
    """(network, task): the network before the training, and the Task of its mode."""
    network = build(trial.network, len(touches.classes), trial.weights, seed, settings.source)
    network = network.to(choose_device(settings.device))
    if trial.weights == "random":
        images = to_images(touches.images, settings.size).to(choose_device(settings.device))
        recalibrate(network, lambda ids: normalise(images[ids]), train)
    return network, mode_named(trial.mode)(network, touches.images, settings.size, settings.copies)


def split_touches(touches: Touches, trial: Trial, settings: Params, random: np.random.Generator) -> Split:
    """The Split of the trial's touches."""
    if trial.split == "objects":
        return by_objects(touches.labels, touches.ranks, trial.repetition, settings.validation_share, random)
    return by_touches(touches.objects, settings.train_share, settings.validation_share, random)


def learning_rate(
    task: Task, labels: np.ndarray, split: Split, trial: Trial, settings: Params, seed: int, searched: Path
) -> tuple[float, float | None]:
    """(rate, validation accuracy) of the best learning rate; `searched` keeps them for an interrupted run.

    A rate without rivals, as a printed one, is not searched and has no validation accuracy.
    """
    rates = settings.frozen_rates if trial.mode == "frozen" else settings.finetuned_rates
    printed = printed_rate(trial, settings) if trial.passes == PRINTED_RATE else None
    if printed or len(rates) == 1:
        return printed or rates[0], None
    if not searched.exists():
        training = _settings(settings, settings.search_epochs, seed)
        write_json(searched, search_rate(task, labels, split.fit, split.validation, rates, **training))
    return read_json(searched)


def change_rows(network: torch.nn.Module, model: torch.nn.Module) -> Iterator[dict]:
    """Rows of the change of the weights of each convolution."""
    belongs = network_parts(network)
    for layer, value in weight_changes(network, model).items():
        yield {"layer": layer, "part": belongs[layer], "metric": "layer_weight_change", "value": value}


def _accuracy_on(task, model, touches, ids):
    return accuracy(predict_probabilities(model, task.inputs, ids), touches.labels[ids])


def _settings(settings, epochs, seed):
    return {"epochs": epochs, "batch": settings.batch, "momentum": settings.momentum, "seed": seed}
