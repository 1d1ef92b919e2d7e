"""Why frozen filters are at chance on a 16 x 16 array in T table 5.3: `python -m benchmarks.coarse_imprints [FOLDER]`

FOLDER: a working tree with data/classes, this one if left out. Trains the head of a frozen MobileNetV2 on imprints of
one setting that differs in one thing at a time: the array, the colour channel, how cells become pixels, the statistics
of the normalisation layers, the learning rate, the number of touches, a real sensor's faults. Touches are drawn at
random for testing, 75:25, five times. Writes reports/transfer/coarse_imprints.csv.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
import torch

from benchmarks import arguments
from stages.classes import read_classes, read_object
from stages.imprints import Skin, press_many
from stages.kit.files import write_table
from stages.kit.repeatable import repeatable
from stages.kit.rng import rng
from stages.networks.images import normalise, to_images
from stages.networks.modes import Task, features
from stages.networks.network import build, settle
from stages.networks.training import accuracy, learn, scores, search
from stages.transfer.split import by_touches, stratified_split
from stages.transfer.touches import choose_vertices

OUT = Path("reports/transfer/coarse_imprints.csv")
TOUCHES, WIDTH = 24, 0.16  # touches an object; of every array, in units
REPETITIONS = 5
RATES = (1e-4, 3e-4, 1e-3, 3e-3, 1e-2)
EPOCHS, SOUGHT = 10, 4  # passes; of each tried rate
TRAINING = {"batch": 16, "momentum": 0.9}


@dataclass(frozen=True)
class Setting:
    """What the frozen network is given. share: of the touches of each object that are trained on."""

    cells: int = 16
    weights: str = "imagenet"
    grey: bool = False  # the imprint in all three channels, not in the red one alone
    blocks: bool = False  # a cell becomes a block of equal pixels, not a smooth passage to the next
    settled: bool = False  # the normalisation layers have the statistics of the touches, not of photographs
    rates: tuple[float, ...] = RATES
    share: float = 1.0
    skin: Skin = Skin()
    size: int = 80


PLAIN = Setting()
SETTINGS = {
    "plain": PLAIN,
    "fine_array": replace(PLAIN, cells=128),
    "random_weights": replace(PLAIN, weights="random", settled=True),
    "three_channels": replace(PLAIN, grey=True),
    "blocks": replace(PLAIN, blocks=True),
    "settled": replace(PLAIN, settled=True),
    "size_224": replace(PLAIN, size=224),
    "rate_of_table_5_3": replace(PLAIN, rates=(1e-5,)),
    "rate_of_table_5_4": replace(PLAIN, rates=(1e-4,)),
    "fine_array_rate_of_table_5_4": replace(PLAIN, cells=128, rates=(1e-4,)),
    "fine_array_rate_of_table_5_3": replace(PLAIN, cells=128, rates=(1e-5,)),
    "quarter_of_the_touches": replace(PLAIN, share=0.25),
    "noise_0.05": replace(PLAIN, skin=Skin(noise=0.05)),
    "noise_0.2": replace(PLAIN, skin=Skin(noise=0.2)),
    "skin": replace(PLAIN, skin=Skin(blur=1.0, noise=0.1, dead=0.05)),
    "skin_and_rate": replace(PLAIN, skin=Skin(blur=1.0, noise=0.1, dead=0.05), rates=(1e-5,)),
}


def pressed(folder, cells):
    """(images (k, cells, cells) f4, labels (k,) i8, objects (k,) i8) of all objects of all classes."""
    images, labels, objects = [], [], []
    for label, names in enumerate(read_classes(folder).values()):
        for name in names:
            mesh, salient = read_object(folder / f"{name}.npz")
            vertices = choose_vertices(mesh, salient["thesis_ssim"], TOUCHES, rng(0, f"touches {name}"))
            images.append(press_many(mesh, vertices, (cells, cells), WIDTH / cells))
            objects += [len(images)] * TOUCHES
            labels += [label] * TOUCHES
    return np.concatenate(images), np.array(labels), np.array(objects)


def inputs(imprints, setting):
    """(k, 3, size, size) f4 in 0..1."""
    felt = setting.skin(imprints)
    if setting.blocks:
        felt = felt.repeat(setting.size // setting.cells, axis=1).repeat(setting.size // setting.cells, axis=2)
    images = to_images(felt, setting.size)
    return images[:, :1].expand(-1, 3, -1, -1) if setting.grey else images


def measured(setting, images, labels, objects):
    """Rows repetition, accuracy on the test touches, learning rate."""
    classes, known = int(labels.max()) + 1, None
    for repetition in range(REPETITIONS):
        random = rng(0, f"coarse {repetition}")
        split = by_touches(objects, 0.75, 0.2, random)
        seed = int(random.integers(2**31))
        with repeatable(seed):
            network = build("mobilenet_v2", classes, setting.weights, seed)
            if setting.settled:
                settle(network, lambda ids: normalise(images[ids]), split.train)
            if known is None or setting.settled:
                known = features(network, images)
            rate, found = answered(network.head, known, labels, objects, split, setting, random)
        yield {"repetition": repetition, "learning_rate": rate, "value": found}


def answered(head, known, labels, objects, split, setting, random):
    """(learning rate, accuracy) of a head trained on the cached features `known`."""
    task = Task(head, lambda ids: known[ids], lambda ids: known[ids], lambda *_: None, lambda others: others)
    train, fit = split.train, split.fit
    if setting.share < 1:
        train, fit = (part[stratified_split(objects[part], setting.share, random)[0]] for part in (train, fit))
    rate = setting.rates[0]
    if len(setting.rates) > 1:
        rate, _ = search(task, labels, fit, split.check, setting.rates, epochs=SOUGHT, **TRAINING)
    model = learn(task, labels, train, rate, EPOCHS, **TRAINING)
    return rate, accuracy(scores(model, task, split.test), labels[split.test])


def main():
    folder = Path(arguments(__doc__, folder=".").folder) / "data/classes"
    data = {cells: pressed(folder, cells) for cells in sorted({one.cells for one in SETTINGS.values()})}
    rows = []
    for name, setting in SETTINGS.items():
        imprints, labels, objects = data[setting.cells]
        about = {"setting": name, "cells": setting.cells, "weights": setting.weights, "size": setting.size}
        about |= {"chance": 1 / (labels.max() + 1), "metric": "accuracy"}
        with torch.no_grad():
            images = inputs(imprints, setting)
        rows += [about | row for row in measured(setting, images, labels, objects)]
        print(f"{name}: {np.mean([row['value'] for row in rows[-REPETITIONS:]]):.1%}", flush=True)
    write_table(OUT, pd.DataFrame(rows))


if __name__ == "__main__":
    main()
