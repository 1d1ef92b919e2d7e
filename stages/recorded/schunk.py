"""Recognition of grasps by a hand with pressure arrays: no grasp is in training and test, and few are all there are."""

import functools
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from haptic_glance.know.split import Split
from stages.kit.run import Rows, StageRun

from .binned import binned, choose
from .touch_series import TouchSeries

METHODS = ("discriminant", "linear_svm", "knn")  # of stages.recorded.binned
FOLDS = 10  # grasps of most objects, so that each fold leaves one of each object out, as the published lists do


def measure(run: StageRun, recordings: dict[str, TouchSeries], repetitions: int) -> None:
    """Adds rows of each method: a row for each grasp, 1 where its object is recognised; the chance is the commonest's.

    part test: the publisher's lists, one grasp of each object for the test; training: each of all grasps is left out
    one time, with one of each other object. Bins and parameter are chosen within the training part of each.
    """
    work = functools.partial(process, series=recordings["grasps"], repetitions=repetitions, seed=run.seed)
    run.each(work, METHODS)


def process(method: str, folder: Path, series: TouchSeries, repetitions: int, seed: int) -> Rows:
    """Rows of one method."""
    with threadpool_limits(1):  # equal sums on any number of cores
        rows = [row for part, out in parts(series) for row in _rows(method, series, part, out, repetitions, seed)]
    return [
        {"group": "grasps", "method": method, "metric": "accuracy", "cells": series.values.shape[1]} | row
        for row in rows
    ]


def parts(series: TouchSeries) -> Iterator[tuple[str, np.ndarray]]:
    """(part, mask of the grasps held out): the published list, then the k-th grasp of each object for all k."""
    yield "test", series.test
    number = np.zeros(len(series.labels), dtype=int)
    for label in np.unique(series.labels):
        own = series.labels == label
        number[own] = np.arange(own.sum()) % FOLDS
    for k in range(number.max() + 1):
        yield "training", number == k


def summary(rows: Rows) -> dict[str, float]:
    """{part.method: the share of grasps recognised}."""
    found: dict[str, list[float]] = {}
    for row in rows:
        found.setdefault(f"{row['part']}.{row['method']}", []).append(row["value"])
    return {name: round(float(np.mean(values)), 6) for name, values in found.items()}


def _rows(method: str, series: TouchSeries, part: str, out: np.ndarray, repetitions: int, seed: int) -> Iterator[dict]:
    known, asked = series.of(~out), series.of(out)
    choice = choose(method, known.values, known.labels, repetitions, seed)
    model = choice.fitted(binned(known.values, choice.bins), known.labels)
    answers = model.predict(binned(asked.values, choice.bins))
    common = {
        "part": part,
        "split": Split.OBJECTS,
        "bins": choice.bins,
        "parameter": choice.parameter,
        "train": len(known.labels),
    }
    for name, label, answer in zip(asked.names, asked.labels, answers, strict=True):
        yield common | {"item": f"{label}/{name}", "value": float(answer == label)}
