"""Which layers are trained: the head alone on cached features, all, or all but a range of layers (T5.3, T5.5)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import torch

from .device import device_of, explain_out_of_memory, mixed_precision
from .images import Transform, augmentation, normalise, to_images
from .layers import frozen_modules, is_range
from .network import Network, recalibrate
from .scaled_head import ScaledHead


@dataclass(frozen=True)
class Task:
    """What a mode trains: the model and its inputs.

    training_inputs(ids) gives the augmented inputs of touches (b,) i8, by torch's random numbers; inputs(ids) the
    inputs without augmentation; encode(images) the inputs of other images (k, 3, size, size) in 0..1. begin(model, ids)
    is called before training on the touches ids, finish(model, ids) after it. fixed: names of the model's modules that
    stay in evaluation mode, so that their statistics do not change.
    """

    model: torch.nn.Module
    training_inputs: Transform
    inputs: Transform
    finish: Callable[[torch.nn.Module, torch.Tensor], None]
    encode: Transform
    fixed: tuple[str, ...] = ()
    begin: Callable[[torch.nn.Module, torch.Tensor], None] = lambda model, ids: None


Mode = Callable[[Network, np.ndarray, int, int], Task]  # of network, imprints, size, copies


def frozen(network: Network, imprints: np.ndarray | list[np.ndarray], size: int, copies: int) -> Task:
    """The Task to train the head alone on the frozen network's features of imprints (k, r, c).

    The network stays in evaluation mode, so that neither its convolutions nor the statistics of their normalisation
    change. Therefore each image's features are computed once and cached. Cached features cannot be augmented, so a few
    augmented copies of each image (`copies`) are cached beside the original, and each step draws among them. The head
    gets them standardised over the training touches.
    """
    network.eval().requires_grad_(False).head.requires_grad_(True)
    images, augment = to_images(imprints, size).to(device_of(network)), augmentation()
    plain = features(network, images)
    cached = torch.stack([plain, *(features(network, images, augment) for _ in range(copies))])

    def drawn(ids):
        return cached[torch.randint(len(cached), (len(ids),)), ids]

    def encode(others):
        return features(network, others.to(plain.device))

    def begin(model, ids):
        model.fit(plain[ids])

    model = ScaledHead(network.head, plain.shape[1]).to(plain.device)
    return Task(model, drawn, lambda ids: plain[ids], lambda head, ids: None, encode, begin=begin)


def finetuned(network: Network, imprints: np.ndarray | list[np.ndarray], size: int, copies: int) -> Task:
    """The Task to train every layer on imprints (k, r, c), augmented again at every step; `copies` is not used."""
    return _imprints(network, imprints, size, ())


def layer_range(name: str) -> Mode:
    """The mode that freezes a range of layers of MobileNetV2 in Matlab's numbers, such as `18:139` (T table 5.6)."""

    def mode(network, imprints, size, copies):
        return _imprints(network, imprints, size, tuple(frozen_modules(name, network)))

    mode.__doc__ = f"The Task to train all layers except {name}."
    return mode


def _imprints(network, imprints, size, fixed):
    return finetuned_except(network, to_images(imprints, size).to(device_of(network)), augmentation(), fixed)


def finetuned_except(network: Network, images: torch.Tensor, augment: Transform, fixed: tuple[str, ...]) -> Task:
    """The Task to train all modules except those named `fixed`, whose weights and statistics stay unchanged.

    images (k, 3, h, w) in 0..1 on the network's device; augment: applied to them in training.
    """
    network.requires_grad_(True)
    for name in fixed:
        network.get_submodule(name).requires_grad_(False)

    def inputs(ids):
        return normalise(images[ids])

    def encode(others):
        return normalise(others.to(images.device))

    def finish(model, ids):
        recalibrate(model, inputs, ids, fixed=fixed)

    return Task(network, lambda ids: normalise(augment(images[ids])), inputs, finish, encode, fixed)


MODES: dict[str, Mode] = {"frozen": frozen, "finetuned": finetuned}


def mode_named(name: str) -> Mode:
    """The function of a mode: a name of MODES or a range of layers; raises ValueError for another."""
    if is_range(name):
        return layer_range(name)
    if name not in MODES:
        raise ValueError(f"unknown mode {name!r}, known: {', '.join(MODES)}, and ranges of layers such as 18:139")
    return MODES[name]


@torch.no_grad()
def features(network: Network, images: torch.Tensor, augment: Transform | None = None, batch: int = 32) -> torch.Tensor:
    """(k, width) f4: the network's features of images (k, 3, h, w) in 0..1, each batch first passed to `augment`."""
    found = []
    for part in images.split(batch):
        with explain_out_of_memory():
            inputs = normalise(part if augment is None else augment(part))  # in full precision, as in training
            with mixed_precision(images.device):
                found.append(network.features(inputs).float())
    return torch.cat(found)
