"""Trains the head of a frozen MobileNetV2 on one variant of the imprints."""

from pathlib import Path

import numpy as np
import torch

from haptic_glance.base.rng import rng
from haptic_glance.deep.images import normalise
from haptic_glance.deep.modes import Task, features
from haptic_glance.deep.network import build, recalibrate
from haptic_glance.deep.training import accuracy, predict_probabilities, search_rate, train_model
from haptic_glance.know.split import Split
from stages.kit.holdout import Split as Parts
from stages.kit.repeatable import repeatable
from stages.kit.run import Rows
from stages.transfer.split import by_touches, stratified_split

from .press import read_imprints
from .schema import Params
from .variants import VARIANTS, Variant


def process(name: str, folder: Path, made: Path, members: dict[str, list[str]], settings: Params, seed: int) -> Rows:
    """Rows of one variant, a row per repetition. made: where press.process has written."""
    variant = VARIANTS[name]
    imprints, labels, objects = read_imprints(made, members, variant.cells)
    about = {"setting": name, "cells": variant.cells, "weights": variant.weights, "size": variant.size}
    about |= {"split": Split.RANDOM, "chance": 1 / len(members), "metric": "accuracy"}
    with torch.no_grad():
        images = variant.images(imprints)
    rows, cached = [], None
    for repetition in range(settings.repetitions):
        random = rng(seed, f"coarse {repetition}")
        split = by_touches(objects, 0.75, 0.2, random)
        start = int(random.integers(2**31))
        with repeatable(start):
            network = build("mobilenet_v2", len(members), variant.weights, start)
            if variant.own_statistics:
                recalibrate(network, lambda ids: normalise(images[ids]), split.train)
            if cached is None or variant.own_statistics:
                cached = features(network, images)
            rate, value = train_head(network.head, cached, labels, objects, split, variant, settings, random)
        rows.append(about | {"repetition": repetition, "learning_rate": rate, "value": value})
    return rows


def train_head(
    head: torch.nn.Module,
    cached: torch.Tensor,
    labels: np.ndarray,
    objects: np.ndarray,
    split: Parts,
    variant: Variant,
    settings: Params,
    random: np.random.Generator,
) -> tuple[float, float]:
    """(learning rate, accuracy on the test touches) of a head trained on the cached features (k, width)."""
    task = Task(head, lambda ids: cached[ids], lambda ids: cached[ids], lambda *_: None, lambda others: others)
    train, fit = split.train, split.fit
    if variant.share < 1:
        train, fit = (part[stratified_split(objects[part], variant.share, random)[0]] for part in (train, fit))
    training = {"batch": settings.batch, "momentum": settings.momentum}
    rate = variant.rates[0]
    if len(variant.rates) > 1:
        epochs = settings.search_epochs
        rate, _ = search_rate(task, labels, fit, split.validation, variant.rates, epochs=epochs, **training)
    model = train_model(task, labels, train, rate, settings.epochs, **training)
    return rate, accuracy(predict_probabilities(model, task.inputs, split.test), labels[split.test])
