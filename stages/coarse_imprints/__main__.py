"""Finds why frozen filters are at chance on a 16 x 16 array in T table 5.3.

Reads data/SET/meshes and data/SET/salient_points of classes of objects. Trains the head of a frozen MobileNetV2 on
imprints of variants that differ in one thing at a time: the array, the colour channel, how cells become pixels, the
statistics of the normalisation layers, the learning rate, the number of touches, a real sensor's faults. A quarter of
the touches, drawn at random, is tested. Writes data/SET/coarse_imprints/imprints/NAME.npz (those of an object) and
reports/measurements/SET/coarse_imprints.csv.gz.
"""

import functools
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import torch

from haptic_glance.base.files import read_mesh, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.deep.images import normalise, to_images
from haptic_glance.deep.modes import Task, features
from haptic_glance.deep.network import build, recalibrate
from haptic_glance.deep.repeatable import repeatable
from haptic_glance.deep.training import accuracy, predict_probabilities, search_rate, train_model
from haptic_glance.deep.weights import imagenet_state
from haptic_glance.know.split import Split
from haptic_glance.touch import Skin, press_many
from stages.engine.rows import named_means
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments
from stages.engine.statistics import Split as Parts
from stages.engine.statistics import stratified_split
from stages.meshes.collect import read_classes
from stages.salient_points.measure import read_points
from stages.transfer.plan import by_touches
from stages.transfer.touches import Touches, choose_vertices, read_touches

from . import COLUMNS, Params

RATES = (1e-4, 3e-4, 1e-3, 3e-3, 1e-2)


@dataclass(frozen=True)
class Variant:
    """A variant of the input of the frozen network. share: of the touches of each object that are trained on."""

    cells: int = 16
    weights: str = "imagenet"
    grey: bool = False  # the imprint in all three channels, not in the red one alone
    blocks: bool = False  # a cell becomes a block of equal pixels, not a smooth passage to the next
    own_statistics: bool = False  # the normalisation layers have the statistics of the touches, not of photographs
    rates: tuple[float, ...] = RATES
    share: float = 1.0
    skin: Skin = Skin()
    size: int = 80

    def images(self, imprints: np.ndarray) -> torch.Tensor:
        """(k, 3, size, size) f4 in 0..1 of imprints (k, cells, cells)."""
        pixels = self.skin(imprints)
        if self.blocks:
            pixels = pixels.repeat(self.size // self.cells, axis=1).repeat(self.size // self.cells, axis=2)
        images = to_images(pixels, self.size)
        return images[:, :1].expand(-1, 3, -1, -1) if self.grey else images


PLAIN = Variant()
FAULTY = Skin(blur=1.0, noise=0.1, dead=0.05)
VARIANTS = {
    "plain": PLAIN,
    "fine_array": replace(PLAIN, cells=128),
    "random_weights": replace(PLAIN, weights="random", own_statistics=True),
    "three_channels": replace(PLAIN, grey=True),
    "blocks": replace(PLAIN, blocks=True),
    "settled": replace(PLAIN, own_statistics=True),
    "size_224": replace(PLAIN, size=224),
    "rate_of_table_5_3": replace(PLAIN, rates=(1e-5,)),
    "rate_of_table_5_4": replace(PLAIN, rates=(1e-4,)),
    "fine_array_rate_of_table_5_4": replace(PLAIN, cells=128, rates=(1e-4,)),
    "fine_array_rate_of_table_5_3": replace(PLAIN, cells=128, rates=(1e-5,)),
    "quarter_of_the_touches": replace(PLAIN, share=0.25),
    "noise_0.05": replace(PLAIN, skin=Skin(noise=0.05)),
    "noise_0.2": replace(PLAIN, skin=Skin(noise=0.2)),
    "skin": replace(PLAIN, skin=FAULTY),
    "skin_and_rate": replace(PLAIN, skin=FAULTY, rates=(1e-5,)),
}


def process(name: str, folder: Path, made: Path, members: dict[str, list[str]], settings: Params, seed: int) -> Rows:
    """Rows of one variant, a row per repetition. made: the folder of the imprints."""
    variant = VARIANTS[name]
    touches = read_touches(made, members, str(variant.cells))
    columns = {"setting": name, "cells": variant.cells, "weights": variant.weights, "size": variant.size}
    columns |= {"split": Split.RANDOM, "chance": 1 / len(members), "metric": "accuracy"}
    with torch.no_grad():
        images = variant.images(touches.images)
    rows, cached = [], None
    for repetition in range(settings.repetitions):
        random = rng(seed, f"coarse {repetition}")
        split = by_touches(touches.objects, 0.75, 0.2, random)
        start = int(random.integers(2**31))
        with repeatable(start):
            network = build("mobilenet_v2", len(members), variant.weights, start)
            if variant.own_statistics:
                recalibrate(network, lambda ids: normalise(images[ids]), split.train)
            if cached is None or variant.own_statistics:
                cached = features(network, images)
            rate, value = train_head(network.head, cached, touches, split, variant, settings, random)
        rows.append(columns | {"repetition": repetition, "learning_rate": rate, "value": value})
    return rows


def train_head(
    head: torch.nn.Module,
    cached: torch.Tensor,
    touches: Touches,
    split: Parts,
    variant: Variant,
    settings: Params,
    random: np.random.Generator,
) -> tuple[float, float]:
    """(learning rate, accuracy on the test touches) of a head trained on the cached features (k, width)."""
    task = Task(head, lambda ids: cached[ids], lambda ids: cached[ids], lambda *_: None, lambda images: images)
    train, fit = split.train, split.fit
    if variant.share < 1:
        train, fit = (part[stratified_split(touches.objects[part], variant.share, random)[0]] for part in (train, fit))
    training = {"batch": settings.batch, "momentum": settings.momentum}
    rate = variant.rates[0]
    if len(variant.rates) > 1:
        epochs = settings.search_epochs
        rate, _ = search_rate(task, touches.labels, fit, split.validation, variant.rates, epochs=epochs, **training)
    model = train_model(task, touches.labels, train, rate, settings.epochs, **training)
    return rate, accuracy(predict_probabilities(model, task.inputs, split.test), touches.labels[split.test])


def press(name: str, folder: Path, data: Path, settings: Params, arrays: list[int], seed: int) -> Rows:
    """Presses each array at the same vertices of an object; writes imprints/NAME.npz, an array per number of cells."""
    mesh, points = read_mesh(data / "meshes" / f"{name}.npz"), read_points(data / "salient_points" / f"{name}.npz")
    if settings.detector not in points:
        raise ValueError(f"coarse_imprints.detector={settings.detector} is not one of {', '.join(points)}")
    vertices = choose_vertices(mesh, points[settings.detector], settings.touches, rng(seed, f"touches {name}"))
    imprints = {str(cells): press_many(mesh, vertices, (cells, cells), settings.width / cells) for cells in arrays}
    write_arrays(folder / "imprints" / f"{name}.npz", vertices=vertices, **imprints)
    return []


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    variants = [VARIANTS[name] for name in settings.variants]
    if any(variant.weights == "imagenet" for variant in variants):
        imagenet_state("mobilenet_v2")  # before the work starts, not in each worker
    with StageRun(workspace, "coarse_imprints", COLUMNS, inputs=("meshes", "salient_points")) as stage:
        members = read_classes(workspace.data / "meshes")
        common = replace(settings, variants=[])  # what an object or a variant depends on
        arrays = sorted({variant.cells for variant in variants})
        work = functools.partial(press, data=workspace.data, settings=common, arrays=arrays, seed=stage.seed)
        objects = [name for names in members.values() for name in names]
        stage.each(work, objects, reads=("meshes/{}.npz", "salient_points/{}.npz"))
        train = functools.partial(process, made=stage.folder, members=members, settings=common, seed=stage.seed)
        stage.each(train, settings.variants, reads=["coarse_imprints"])
        stage.metrics(named_means((row["setting"], row["value"]) for row in stage.rows))
    print(f"coarse_imprints: {workspace.dataset}, {len(members)} classes, {len(variants)} variants")


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "coarse_imprints"))
