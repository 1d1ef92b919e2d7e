"""Trainings of one network on recorded touches."""

import itertools
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch

from stages.kit import Stopwatch
from stages.kit.repeatable import repeatable
from stages.kit.rng import rng
from stages.kit.run import Rows
from stages.networks.device import explain_out_of_memory
from stages.networks.network import count_parameters
from stages.networks.training import accuracy, predict_probabilities, search_rate, train_model
from stages.networks.weights import available_weights
from stages.recorded.splits import split_number

from .parts import groups_of, parts
from .schema import Params
from .sources import Recording
from .tasks import finetuned, frozen, frozen_features

MODES = ("frozen", "finetuned")


class Run(NamedTuple):
    """One training: what is recognised, how it is split, and the number of the split."""

    data: str
    split: str
    repetition: int


@dataclass(frozen=True)
class Trial:
    """Trainings of a network that are made together: those that share frozen features, or one that is fine-tuned.

    ImageNet's features are shared by all runs, those of an untrained network by the runs of one repetition: each
    repetition draws its own, so that an interval over repetitions covers the draw of the weights, too.
    """

    method: str
    weights: str
    mode: str
    runs: tuple[Run, ...]

    @property
    def name(self) -> str:
        """Tells the trial apart from all others of the stage."""
        own = () if (self.weights, self.mode) == ("imagenet", "frozen") else self.runs[0]
        return "-".join(map(str, (self.method, self.weights, self.mode, *own)))


def trials(recordings: dict[str, Recording], settings: Params) -> list[Trial]:
    """All that is trained. ValueError for a mode that is not one of MODES."""
    found = []
    for method, modes in settings.networks.items():
        for mode, weights in itertools.product(modes, settings.weights):
            if mode not in MODES:
                raise ValueError(f"recorded_networks.networks.{method}: {mode!r} is not one of {', '.join(MODES)}")
            runs = [
                Run(data, str(split), repetition)
                for data, recording in recordings.items()
                for split in recording.splits
                for repetition in range(settings.repetitions[mode])
            ]
            draws = [[run for run in runs if run.repetition == draw] for draw in range(settings.repetitions[mode])]
            if mode == "finetuned":
                draws = [[run] for run in runs]
            elif weights == "imagenet":
                draws = [runs]
            found += [Trial(method, weights, mode, tuple(together)) for together in draws]
    return found


@explain_out_of_memory()
def process(trial: Trial, folder: Path, recordings: dict[str, Recording], settings: Params, seed: int) -> Rows:
    """Makes the trainings of a trial and tests each network; returns the rows."""
    cached = frozen_features_by_data(trial, recordings, settings, seed) if trial.mode == "frozen" else {}
    common = {"method": trial.method, "weights": trial.weights, "mode": trial.mode, "size": settings.size}
    common["pretrained"] = available_weights(trial.method, settings.source) if trial.weights == "imagenet" else "none"
    rows = []
    for one in trial.runs:
        features, seconds = cached.get(one.data, (torch.empty(0), 0.0))
        found = _train(trial, one, recordings[one.data], features, settings, seed)
        found[0]["seconds"] += seconds  # of the features, shared by several runs and counted in each
        rows += [common | one._asdict() | row for row in found]
    return rows


def frozen_features_by_data(
    trial: Trial, recordings: dict[str, Recording], settings: Params, seed: int
) -> dict[str, tuple[torch.Tensor, float]]:
    """{data: (features, seconds that they took)}; what has the same images has the same features."""
    found: dict[str, tuple[torch.Tensor, float]] = {}
    for data in dict.fromkeys(run.data for run in trial.runs):
        images = recordings[data].touches.images
        same = [one for one in found if np.array_equal(recordings[one].touches.images, images)]
        if same:
            found[data] = found[same[0]]
            continue
        with repeatable(seed), Stopwatch() as watch:
            features = frozen_features(
                recordings[data], trial.method, trial.weights, trial.runs[0].repetition, settings
            )
        found[data] = features, watch.seconds
    return found


def _train(trial: Trial, one: Run, recording: Recording, features: torch.Tensor, settings: Params, seed: int) -> Rows:
    """Rows of one training, the accuracy first."""
    mode, labels, classes = trial.mode, recording.touches.labels, len(recording.touches.classes)
    fit, validation, test = parts(recording, one.split, split_number(seed, one.repetition))
    train = np.sort(np.concatenate([fit, validation]))
    head, order = (int(value) for value in rng(seed, f"{one.data} {one.repetition}").integers(2**31, size=2))
    with repeatable(order), Stopwatch() as watch:
        if mode == "frozen":
            network, task = frozen(features, classes, train, trial.method, head)
        else:
            network, task = finetuned(recording, train, trial.method, trial.weights, head, settings)
        training = {"batch": settings.batch[mode], "momentum": settings.momentum}
        epochs = passes(mode, len(train), settings)
        tried = max(1, round(settings.search_epochs[mode] * epochs / settings.epochs[mode]))
        rate, validated = search_rate(task, labels, fit, validation, settings.rates[mode], epochs=tried, **training)
        model = train_model(task, labels, train, rate, epochs=epochs, **training)
        found = predict_probabilities(model, task.inputs, test)
    commonest = np.bincount(labels[train], minlength=classes).argmax()
    values = {
        "accuracy": accuracy(found, labels[test]),
        "chance": 1 / classes,
        "majority": float((labels[test] == commonest).mean()),
        "validation_accuracy": validated,
        "learning_rate": rate,
        "epochs": epochs,
        "parameters": count_parameters(network),
        "trained_parameters": count_parameters(model, trained=True),
    }
    rows = [{"metric": key, "value": value} for key, value in values.items()]
    rows[0]["seconds"] = watch.seconds
    for name in recording.test_objects:
        own = groups_of(recording)[test] == name
        value = accuracy(found[torch.as_tensor(own)], labels[test][own])
        rows.append({"item": name, "metric": "accuracy", "value": value})
    return rows


def passes(mode: str, touches: int, settings: Params) -> int:
    """Passes of a training: those of the settings, of fine-tuning as many as `steps` allow."""
    if mode == "frozen":
        return settings.epochs[mode]
    return max(1, min(settings.epochs[mode], round(settings.steps * settings.batch[mode] / touches)))
