"""Trainings of one network on recorded touches."""

import itertools
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep.device import explain_out_of_memory, repeatable
from haptic_glance.deep.network import UNNORMALISED, count_parameters
from haptic_glance.deep.training import (
    CONVERGED,
    PRINTED,
    Diverged,
    Learning,
    accuracy,
    predict_probabilities,
    search_rate,
    train_model,
)
from haptic_glance.deep.weights import available_weights
from stages.engine.run import Rows
from stages.recorded.splits import split_number

from . import Params
from .data import Recording, finetuned, frozen, frozen_features, groups_of, parts

MODES = ("frozen", "finetuned")


class Run(NamedTuple):
    """One training: what is recognised, how it is split, the number of the split, and how many passes are made."""

    data: str
    split: str
    repetition: int
    passes: str = PRINTED


@dataclass(frozen=True)
class Trial:
    """Trainings of a network that are made together: those that share frozen features, or one that is fine-tuned.

    ImageNet's features are shared by all runs. An untrained network is shared by the runs of one repetition: each
    repetition draws its own, so that an interval over repetitions covers the draw of the weights, too.
    """

    method: str
    weights: str
    mode: str
    runs: tuple[Run, ...]

    @property
    def name(self) -> str:
        """Tells the trial apart from all others of the stage."""
        detail = () if (self.weights, self.mode) == ("imagenet", "frozen") else self.runs[0][:3]
        ends = {run.passes for run in self.runs} - {PRINTED}
        return "-".join(map(str, (self.method, self.weights, self.mode, *detail, *sorted(ends))))


def trials(recordings: dict[str, Recording], settings: Params) -> list[Trial]:
    """All that is trained. ValueError for a mode that is not one of MODES."""
    trial_list = []
    for method, modes in settings.networks.items():
        for mode, weights, passes in itertools.product(modes, settings.weights, settings.passes):
            if mode not in MODES:
                raise ValueError(f"recorded_networks.networks.{method}: {mode!r} is not one of {', '.join(MODES)}")
            if weights == "random_initial" and (mode != "frozen" or method in UNNORMALISED):
                continue  # training sets the statistics anew
            runs = [
                Run(data, str(split), repetition, passes)
                for data, recording in recordings.items()
                for split in recording.splits
                for repetition in range(settings.repetitions[mode])
            ]
            draws = [[run for run in runs if run.repetition == draw] for draw in range(settings.repetitions[mode])]
            if mode == "finetuned":
                draws = [[run] for run in runs]
            elif weights == "imagenet":
                draws = [runs]
            trial_list += [Trial(method, weights, mode, tuple(together)) for together in draws]
    return trial_list


@explain_out_of_memory()
def process(trial: Trial, folder: Path, recordings: dict[str, Recording], settings: Params, seed: int) -> Rows:
    """Makes the trainings of a trial and tests each network; returns the rows."""
    cached = frozen_features_by_run(trial, recordings, settings, seed) if trial.mode == "frozen" else {}
    common = {"method": trial.method, "weights": trial.weights, "mode": trial.mode, "size": settings.size}
    common["pretrained"] = available_weights(trial.method, settings.source) if trial.weights == "imagenet" else "none"
    rows = []
    for run in trial.runs:
        features, seconds = cached.get(run, (torch.empty(0), 0.0))
        run_rows = _train(trial, run, recordings[run.data], features, settings, seed)
        if "seconds" in run_rows[0]:
            run_rows[0]["seconds"] += seconds  # of the features, shared by several runs and counted in each
        rows += [common | run._asdict() | row for row in run_rows]
    return rows


def frozen_features_by_run(
    trial: Trial, recordings: dict[str, Recording], settings: Params, seed: int
) -> dict[Run, tuple[torch.Tensor, float]]:
    """{run: (features, seconds that they took)}; runs on the same images share their features.

    The normalisation of a `random` network has the statistics of the images that the run learns from: runs share its
    features only where they also learn from the same images.
    """
    by_run: dict[Run, tuple[torch.Tensor, float]] = {}
    made: list[tuple[np.ndarray, np.ndarray, Run]] = []
    for run in trial.runs:
        recording = recordings[run.data]
        images, sample = recording.touches.images, np.arange(0)
        if trial.weights == "random" and trial.method not in UNNORMALISED:
            sample = _sides(recording, run, seed)[0]
        twins = [other for *arrays, other in made if all(map(np.array_equal, arrays, (images, sample)))]
        if twins:
            by_run[run] = by_run[twins[0]]
            continue
        with repeatable(seed), Stopwatch() as watch:
            features = frozen_features(recording, trial.method, trial.weights, run.repetition, settings, sample)
        by_run[run] = features, watch.seconds
        made.append((images, sample, run))
    return by_run


def _sides(recording: Recording, run: Run, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(learned, fit, validation, test): ids; learned is `fit` of a training to convergence, else the first two."""
    fit, validation, test = parts(recording, run.split, split_number(seed, run.repetition))
    learned = fit if run.passes == CONVERGED else np.sort(np.concatenate([fit, validation]))
    return learned, fit, validation, test


def _train(trial: Trial, run: Run, recording: Recording, features: torch.Tensor, settings: Params, seed: int) -> Rows:
    """Rows of one training, the accuracy first; of one that diverged a row with a note."""
    mode, labels, classes = trial.mode, recording.touches.labels, len(recording.touches.classes)
    learned, fit, validation, test = _sides(recording, run, seed)
    train, converged = np.sort(np.concatenate([fit, validation])), run.passes == CONVERGED
    learning = Learning(validation if converged else None, settings.patience)
    head, order = (int(value) for value in rng(seed, f"{run.data} {run.repetition}").integers(2**31, size=2))
    with repeatable(order), Stopwatch() as watch:
        if mode == "frozen":
            network, task = frozen(features, classes, learned, trial.method, head)
        else:
            network, task = finetuned(recording, learned, trial.method, trial.weights, head, settings)
        training = {"batch": settings.batch[mode], "momentum": settings.momentum}
        epochs = passes(mode, len(train), settings)
        few_epochs = max(1, round(settings.search_epochs[mode] * epochs / settings.epochs[mode]))
        rate, validated = search_rate(
            task, labels, fit, validation, settings.rates[mode], epochs=few_epochs, **training
        )
        most = settings.most_epochs if converged else epochs
        try:
            model = train_model(task, labels, learned, rate, epochs=most, learning=learning, **training)
        except Diverged as error:
            return [{"metric": "accuracy", "value": None, "note": str(error)}]
        on_test, on_learned, on_validation = (
            predict_probabilities(model, task.inputs, ids) for ids in (test, learned, validation)
        )
    commonest = np.bincount(labels[train], minlength=classes).argmax()
    values = {
        "accuracy": accuracy(on_test, labels[test]),
        "train_accuracy": accuracy(on_learned, labels[learned]),
        "chance": 1 / classes,
        "majority": float((labels[test] == commonest).mean()),
        "validation_accuracy": accuracy(on_validation, labels[validation]) if converged else validated,
        "learning_rate": rate,
        "epochs": len(learning.curve),
        "parameters": count_parameters(network),
        "trained_parameters": count_parameters(model, trained=True),
    }
    rows: list[dict] = [{"metric": key, "value": value} for key, value in values.items()]
    rows[0]["seconds"] = watch.seconds
    for name in recording.test_objects:
        mask = groups_of(recording)[test] == name
        value = accuracy(on_test[torch.as_tensor(mask)], labels[test][mask])
        rows.append({"item": name, "metric": "accuracy", "value": value})
    return rows


def passes(mode: str, touches: int, settings: Params) -> int:
    """Passes of a training: those of the settings, of fine-tuning as many as `steps` allow."""
    if mode == "frozen":
        return settings.epochs[mode]
    return max(1, min(settings.epochs[mode], round(settings.steps * settings.batch[mode] / touches)))
