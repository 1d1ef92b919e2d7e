"""What a network trains on recorded touches: its head alone on cached features, or all its layers."""

import zlib
from pathlib import Path

import numpy as np
import torch

from benchmarks._transfer_data import SOURCES
from stages.kit import Stopwatch
from stages.kit.files import read_arrays, write_arrays
from stages.networks.device import choose
from stages.networks.images import augmentation, normalise, to_images
from stages.networks.modes import Task
from stages.networks.network import build, settle

BUILD = Path("build/transfer")
COPIES = 2  # augmented copies of each image whose frozen features are cached
SOME = 512  # images, at most, that an untrained network's normalisation is settled on


def as_images(images, size):
    """(k, 3, size, size) in 0..1 of images (k, r, c) or (k, r, c, 3) u1: grey in the red channel alone (T5.3)."""
    if images.ndim == 3:
        return to_images(images, size)
    return torch.stack([to_images(images[..., k], size)[:, 0] for k in range(3)], dim=1)


def frozen(trial, recorded, train, source, device, seed):
    """The head alone on cached features, each scaled by its mean and deviation over the training part.

    The scale is the same for all networks, so that one set of learning rates serves them: an untrained network's
    features differ from image to image by a hundredth of their size, and its head would learn nothing in the time.
    """
    network = build(trial.method, len(recorded.classes), "random", seed)
    cached = torch.as_tensor(cached_features(trial, recorded, source, device)["features"])
    plain = cached[0, train]
    spread = plain.std(dim=0)
    cached = (cached - plain.mean(dim=0)) / torch.where(spread > 1e-6 * spread.max(), spread, 1)

    def drawn(ids):
        return cached[torch.randint(len(cached), (len(ids),)), ids]

    return network, _task(network.head, drawn, lambda ids: cached[0, ids], lambda head, ids: None)


def finetuned(trial, recorded, train, source, device, seed):
    """All layers, on images augmented anew at every step where that makes sense."""
    where, moved = choose(device), augmentation()
    images = as_images(recorded.images, trial.size).to(where)
    network = build(trial.method, len(recorded.classes), trial.weights, seed, source).to(where)
    network.requires_grad_(True)

    def inputs(ids):
        return normalise(images[ids])

    def drawn(ids):
        return normalise(moved(images[ids])) if SOURCES[trial.data].augmented else inputs(ids)

    if trial.weights == "random":
        settle(network, inputs, train)
    return network, _task(network, drawn, inputs, lambda model, ids: settle(model, inputs, ids))


TASKS = {"frozen": frozen, "finetuned": finetuned}


def _task(model, drawn, inputs, finish):
    return Task(model=model, training_inputs=drawn, inputs=inputs, finish=finish, encode=normalise)


@torch.no_grad()
def cached_features(trial, recorded, source, device):
    """features (1 + copies, k, width) f4: the frozen network's features of all images, plain first, then augmented.

    They are the same for every split and repetition, and for all that is asked about a data set. The untrained network
    is one, drawn by the method's name; its normalisation is settled on some images of all parts, without their labels.
    Also gives the seconds that this took when it was done.
    """
    named = SOURCES[trial.data].dataset, trial.method, trial.weights, source, trial.size, COPIES, SOME
    kept = BUILD / "features" / f"{'-'.join(map(str, named))}.npz"
    if kept.exists():
        return read_arrays(kept)
    where, moved = choose(device), augmentation()
    network = build(trial.method, 2, trial.weights, zlib.crc32(trial.method.encode()), source).to(where)

    def inputs(ids, change=lambda images: images):
        return normalise(change(as_images(recorded.images[ids.numpy()], trial.size).to(where)))

    ids = torch.arange(len(recorded.images))
    with torch.random.fork_rng(), Stopwatch() as watch:
        torch.manual_seed(0)
        if trial.weights == "random":
            settle(network, inputs, ids[:: max(1, len(ids) // SOME)])
        changes = [{}] + [{"change": moved}] * (COPIES if SOURCES[trial.data].augmented else 0)
        found = [torch.cat([network.features(inputs(part, **how)).cpu() for part in ids.split(32)]) for how in changes]
    write_arrays(kept, features=torch.stack(found).numpy(), seconds=np.array(watch.seconds))
    return read_arrays(kept)
