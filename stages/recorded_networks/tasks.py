"""What a network trains on recorded touches: its head alone on cached features, or all its layers."""

import zlib
from collections.abc import Callable

import numpy as np
import torch

from haptic_glance.deep.device import choose_device
from haptic_glance.deep.images import augmentation, normalise, to_images
from haptic_glance.deep.modes import Task
from haptic_glance.deep.network import Network, build, recalibrate

from .schema import Params
from .sources import Recording

SOME = 512  # images, at most, that an untrained network's normalisation takes its statistics from


def as_images(images: np.ndarray, size: int) -> torch.Tensor:
    """(k, 3, size, size) in 0..1 of images (k, r, c) or (k, r, c, 3) u1: grey in the red channel alone (T5.3)."""
    if images.ndim == 3:
        return to_images(images, size)
    return torch.stack([to_images(images[..., k], size)[:, 0] for k in range(3)], dim=1)


def frozen(features: torch.Tensor, classes: int, train: np.ndarray, method: str, seed: int) -> tuple[Network, Task]:
    """The head alone on cached features (1 + copies, k, width), scaled by mean and deviation over the training part.

    The scale is the same for all networks, so that one set of learning rates serves them: an untrained network's
    features differ from image to image by a hundredth of their size, and its head would learn nothing in the time.
    """
    network = build(method, classes, "random", seed)
    plain = features[0, train]
    spread = plain.std(dim=0)
    scaled = (features - plain.mean(dim=0)) / torch.where(spread > 1e-6 * spread.max(), spread, 1)

    def drawn(ids):
        return scaled[torch.randint(len(scaled), (len(ids),)), ids]

    return network, _task(network.head, drawn, lambda ids: scaled[0, ids], lambda head, ids: None)


def finetuned(
    recording: Recording, train: np.ndarray, method: str, weights: str, seed: int, settings: Params
) -> tuple[Network, Task]:
    """All layers, on images augmented anew at every step where that makes sense."""
    where, moved = choose_device(settings.device), augmentation()
    images = as_images(recording.touches.images, settings.size).to(where)
    network = build(method, len(recording.touches.classes), weights, seed, settings.source).to(where)
    network.requires_grad_(True)

    def inputs(ids):
        return normalise(images[ids])

    def drawn(ids):
        return normalise(moved(images[ids])) if recording.augmented else inputs(ids)

    if weights == "random":
        recalibrate(network, inputs, train)
    return network, _task(network, drawn, inputs, lambda model, ids: recalibrate(model, inputs, ids))


@torch.no_grad()
def frozen_features(recording: Recording, method: str, weights: str, draw: int, settings: Params) -> torch.Tensor:
    """(1 + copies, k, width) f4: the frozen network's features of all images, plain first, then augmented.

    They are the same for every split. An untrained network is drawn by the method's name and the number of the draw;
    its normalisation has the statistics of some images of all parts, without their labels.
    """
    where, moved = choose_device(settings.device), augmentation()
    network = build(method, 2, weights, zlib.crc32(f"{method} {draw}".encode()), settings.source).to(where)

    def inputs(ids, change=lambda images: images):
        return normalise(change(as_images(recording.touches.images[ids.numpy()], settings.size).to(where)))

    ids = torch.arange(len(recording.touches.images))
    if weights == "random":
        recalibrate(network, inputs, ids[:: max(1, len(ids) // SOME)])
    changes = [{}] + [{"change": moved}] * (settings.copies if recording.augmented else 0)
    return torch.stack(
        [torch.cat([network.features(inputs(part, **how)).cpu() for part in ids.split(32)]) for how in changes]
    )


def _task(model: torch.nn.Module, drawn: Callable, inputs: Callable, finish: Callable) -> Task:
    return Task(model=model, training_inputs=drawn, inputs=inputs, finish=finish, encode=normalise)
