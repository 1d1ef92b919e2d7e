"""One training: start weights, mode, repetition. It is the unit that an interrupted run does not repeat."""

import itertools

import numpy as np
import pandas as pd

from stages.kit import Stopwatch
from stages.kit.files import read_arrays, write_arrays
from stages.kit.repeatable import repeatable
from stages.kit.rng import rng
from stages.kit.stats import bootstrap_interval
from stages.networks.images import normalise, to_images
from stages.networks.modes import MODES
from stages.networks.network import START, build, parameters, settle
from stages.networks.training import accuracy, learn, scores, search

from .split import stratified_split
from .touches import read_touches


def trials(settings):
    """Names of all trainings, WEIGHTS-MODE-REPETITION; raises ValueError for weights or modes that are not known."""
    for key, known in (("weights", START), ("modes", tuple(MODES))):
        strange = sorted(set(getattr(settings, key)) - set(known))
        if strange:
            raise ValueError(f"transfer.{key}: {', '.join(strange)} not known, choose of {', '.join(known)}")
    if settings.repetitions < 1 or not settings.weights or not settings.modes:
        raise ValueError("transfer: repetitions must be 1 or more, and weights and modes name at least one each")
    return [
        f"{w}-{m}-{r}" for w, m, r in itertools.product(settings.weights, settings.modes, range(settings.repetitions))
    ]


def process(name, folder, settings, classes, seed):
    """Trains one network and tests it; writes networks/NAME.npz and predictions/NAME.npz, returns the rows.

    The split, the head's first weights and the random numbers of the training depend on the repetition alone, so that
    weights and modes are compared on the same touches. `seconds` is the whole of it: features or training, search and
    final training, on one thread, without the test.
    """
    weights, mode, repetition = name.split("-")
    touches = read_touches(folder, classes)
    labels, generator = touches.labels, rng(seed, f"transfer {repetition}")
    train, test = stratified_split(labels, settings.train_share, generator)
    validation, part = stratified_split(labels[train], settings.validation_share, generator)
    training = {"batch": settings.batch, "momentum": settings.momentum}
    with repeatable(int(generator.integers(2**31))), Stopwatch() as watch:
        start = int(generator.integers(2**31))
        network = build(settings.network, len(classes), weights, start, settings.source)
        size, rates = plan(settings, mode)
        if weights == "random":
            images = to_images(touches.images, size)
            settle(network, lambda ids: normalise(images[ids]), train)
        task = MODES[mode](network, touches.images, size, settings.copies)
        rate, validated = search(
            task, labels, train[part], train[validation], rates, epochs=settings.search_epochs, **training
        )
        model = learn(task, labels, train, rate, epochs=settings.epochs, **training)
    with repeatable(0):
        found = scores(model, task, test)
    state = {key: np.ascontiguousarray(value.numpy()) for key, value in model.state_dict().items()}
    write_arrays(folder / "networks" / f"{name}.npz", **state)
    write_arrays(folder / "predictions" / f"{name}.npz", test=test, true=labels[test], scores=found.numpy())
    values = {
        "accuracy": accuracy(found, labels[test]),
        "chance": 1 / len(classes),
        "validation_accuracy": validated,
        "learning_rate": rate,
        "parameters": parameters(network),
        "trained_parameters": parameters(model, trained=True),
    }
    known = {"object": settings.class_set, "method": settings.network, "weights": weights, "mode": mode}
    known["repetition"] = int(repetition)
    seconds = {"accuracy": watch.seconds}
    return [known | {"metric": key, "value": value, "seconds": seconds.get(key)} for key, value in values.items()]


def plan(settings, mode):
    """(image size, learning rates to try) of a mode."""
    if mode == "frozen":
        return settings.frozen_size, settings.frozen_rates
    return settings.finetuned_size, settings.finetuned_rates


def confusion(folder, names, classes):
    """Tidy frame of the confusion matrices: trial, true class, predicted class, count of test touches."""
    rows = []
    for name in names:
        stored = read_arrays(folder / "predictions" / f"{name}.npz")
        counts = np.zeros((len(classes), len(classes)), dtype=int)
        np.add.at(counts, (stored["true"], stored["scores"].argmax(axis=1)), 1)
        rows += [
            {"trial": name, "true": classes[i], "predicted": classes[j], "count": counts[i, j]}
            for i, j in np.ndindex(counts.shape)
        ]
    return pd.DataFrame(rows)


def summary(rows, seed):
    """Accuracy a kind of start weights and a mode, with its interval over the repetitions, and chance."""
    frame = pd.DataFrame(rows)
    found = {"chance": round(float(frame.loc[frame["metric"] == "chance", "value"].iloc[0]), 6)}
    for (weights, mode), part in frame[frame["metric"] == "accuracy"].groupby(["weights", "mode"]):
        mean, low, high = np.round(bootstrap_interval(part["value"], seed), 6).tolist()
        interval = {"low": low, "high": high} if np.isfinite(low) else {}
        found[f"{mode}_{weights}"] = {"accuracy": {"value": mean} | interval}
    return found
