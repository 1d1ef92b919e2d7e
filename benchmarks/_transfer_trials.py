"""One training of a network on recorded touches: what an interrupted run does not repeat."""

import functools
import zlib
from dataclasses import asdict, dataclass

import numpy as np
import torch

from benchmarks import _transfer_tasks as tasks
from benchmarks._transfer_data import SOURCES, parts
from stages.kit import Stopwatch
from stages.kit.files import read_json, write_json
from stages.kit.repeatable import repeatable
from stages.kit.rng import rng
from stages.networks.device import enough_memory
from stages.networks.network import parameters
from stages.networks.training import accuracy, learn, scores, search
from stages.networks.weights import had

MOMENTUM = 0.9  # T5.3
BATCH = {"frozen": 32, "finetuned": 16}  # the thesis's is 16; a head of its own takes twice that at half the time
RATES = {"frozen": (0.001, 0.003, 0.01, 0.03), "finetuned": (0.0003, 0.001, 0.003)}
EPOCHS = {"frozen": 20, "finetuned": 10}  # T tables 5.1 to 5.5: 10 or 20
SEARCH_EPOCHS = {"frozen": 8, "finetuned": 3}
STEPS = 600  # of fine-tuning at most, in whole passes: ten of 825 pressure images, two of the 4,373 grasps


@dataclass(frozen=True)
class Trial:
    """A training, by all that its result depends on."""

    data: str
    method: str
    weights: str
    mode: str
    size: int
    split: str
    repetition: int

    @property
    def name(self):
        return "-".join(str(value) for value in asdict(self).values())


@functools.lru_cache(1)
def read(name, path):
    """(Recorded, names of the objects kept for testing) of a source."""
    return SOURCES[name].read(path)


def process(trial, paths, source, device, seed=0):
    """Trains one network and tests it; returns the rows. What was computed before, with these settings, is read."""
    kept = tasks.BUILD / "trials" / f"{trial.name}.json"
    settings = _settings(source)
    if kept.exists() and (stored := read_json(kept))["settings"] == settings:
        return stored["rows"]
    recorded, kept_for_test = read(trial.data, paths[SOURCES[trial.data].argument])
    rows = _train(trial, recorded, kept_for_test, source, device, seed)
    write_json(kept, {"settings": settings, "rows": rows})
    return rows


def done(source):
    """Rows of all trainings that were done with these settings, by their names."""
    for file in sorted((tasks.BUILD / "trials").glob("*.json")):
        if (stored := read_json(file))["settings"] == _settings(source):
            yield from stored["rows"]


def _settings(source):
    found = [MOMENTUM, BATCH, RATES, EPOCHS, SEARCH_EPOCHS, STEPS, tasks.COPIES, tasks.SOME, source]
    return f"{zlib.crc32(repr(found).encode()):08x}"


@enough_memory()
def _train(trial, recorded, kept_for_test, source, device, seed):
    number = int(rng(0, f"repetition {trial.repetition}").integers(2**31))  # that of reports/touch: the same splits
    learnt, validation, test = parts(recorded, trial.split, number, kept_for_test)
    train, labels = np.sort(np.concatenate([learnt, validation])), recorded.labels
    generator = rng(seed, f"{trial.data} {trial.repetition}")
    head, order = (int(value) for value in generator.integers(2**31, size=2))
    before = tasks.cached_features(trial, recorded, source, device)["seconds"] if trial.mode == "frozen" else 0
    with repeatable(order), Stopwatch() as watch:
        network, task = tasks.TASKS[trial.mode](trial, recorded, train, source, device, head)
        told = {"batch": BATCH[trial.mode], "momentum": MOMENTUM}
        epochs = _epochs(trial.mode, len(train))
        tries = max(1, round(SEARCH_EPOCHS[trial.mode] * epochs / EPOCHS[trial.mode]))
        rate, validated = search(task, labels, learnt, validation, RATES[trial.mode], epochs=tries, **told)
        model = learn(task, labels, train, rate, epochs=epochs, **told)
        found = scores(model, task, test)
    commonest = np.bincount(labels[train], minlength=len(recorded.classes)).argmax()
    values = {
        "accuracy": accuracy(found, labels[test]),
        "chance": 1 / len(recorded.classes),
        "majority": float((labels[test] == commonest).mean()),
        "validation_accuracy": validated,
        "learning_rate": rate,
        "epochs": epochs,
        "parameters": parameters(network),
        "trained_parameters": parameters(model, trained=True),
    }
    said = {"dataset": SOURCES[trial.data].dataset, **asdict(trial), "seed": number}
    said["had"] = had(trial.method, source) if trial.weights == "imagenet" else "none"
    rows = [{**said, "object": "all", "metric": key, "value": value} for key, value in values.items()]
    rows[0]["seconds"] = float(before) + watch.seconds  # a frozen network's features are shared, and counted in each
    for name in kept_for_test:
        own = recorded.groups[test] == name
        value = accuracy(found[torch.as_tensor(own)], labels[test][own])
        rows.append({**said, "object": name, "metric": "accuracy", "value": value})
    return rows


def _epochs(mode, touches):
    if mode == "frozen":
        return EPOCHS[mode]
    return max(1, min(EPOCHS[mode], round(STEPS * BATCH[mode] / touches)))
