"""What of the network learns: the head alone on cached features, all, or all but a range of layers (T5.3, T5.5)."""

from collections.abc import Callable
from dataclasses import dataclass

import torch

from .device import device_of, enough_memory, mixed
from .images import augmentation, normalise, to_images
from .layers import frozen_modules, is_range
from .network import settle
from .scaled import Scaled


@dataclass(frozen=True)
class Task:
    """What a mode trains: the model, and what it is fed.

    training_inputs(ids) gives the augmented inputs of touches (b,) i8, drawn from torch's random numbers;
    inputs(ids) the plain ones, always the same; finish(model, ids) is what is left to do when training on the
    touches ids ends; encode(images) gives the inputs of other images (k, 3, size, size) in 0..1; begin(model, ids)
    comes before. fixed: names of the model's modules that stay in evaluation mode, so that their statistics stay
    too.
    """

    model: torch.nn.Module
    training_inputs: Callable[[torch.Tensor], torch.Tensor]
    inputs: Callable[[torch.Tensor], torch.Tensor]
    finish: Callable[[torch.nn.Module, torch.Tensor], None]
    encode: Callable[[torch.Tensor], torch.Tensor]
    fixed: tuple[str, ...] = ()
    begin: Callable[[torch.nn.Module, torch.Tensor], None] = lambda model, ids: None


def frozen(network, imprints, size, copies):
    """The Task to train the head alone on what the frozen network makes of imprints (k, r, c).

    Nothing of the convolutions changes, and neither do the statistics of their normalisation: the network stays in
    evaluation mode. So each image's features are computed once and cached. Cached features cannot be augmented: a few
    augmented copies of each image (`copies`) are cached beside the plain one, and each step draws among them. The head
    sees them scaled by the touches that it learns from.
    """
    network.eval().requires_grad_(False).head.requires_grad_(True)
    images, moved = to_images(imprints, size).to(device_of(network)), augmentation()
    plain = features(network, images)
    cached = torch.stack([plain, *(features(network, images, moved) for _ in range(copies))])

    def drawn(ids):
        return cached[torch.randint(len(cached), (len(ids),)), ids]

    def encode(others):
        return features(network, others.to(plain.device))

    def begin(model, ids):
        model.fit(plain[ids])

    model = Scaled(network.head, plain.shape[1]).to(plain.device)
    return Task(model, drawn, lambda ids: plain[ids], lambda head, ids: None, encode, begin=begin)


def finetuned(network, imprints, size, copies):
    """The Task to train every layer on imprints (k, r, c), augmented anew at every step: no copies needed."""
    return _imprints(network, imprints, size, ())


def layer_range(name):
    """The mode that freezes a range of layers of MobileNetV2, in Matlab's numbers, such as `18:139` (T table 5.6)."""

    def mode(network, imprints, size, copies):
        return _imprints(network, imprints, size, tuple(frozen_modules(name, network)))

    mode.__doc__ = f"The Task to train every layer but {name}."
    return mode


def _imprints(network, imprints, size, fixed):
    return all_but(network, to_images(imprints, size).to(device_of(network)), augmentation(), fixed)


def all_but(network, images, moved, fixed):
    """The Task to train all but the modules named `fixed`, whose weights and statistics stay as they are.

    images (k, 3, h, w) in 0..1 on the network's device; moved: their augmentation in training.
    """
    network.requires_grad_(True)
    for name in fixed:
        network.get_submodule(name).requires_grad_(False)

    def inputs(ids):
        return normalise(images[ids])

    def encode(others):
        return normalise(others.to(images.device))

    def finish(model, ids):
        settle(model, inputs, ids, fixed=fixed)

    return Task(network, lambda ids: normalise(moved(images[ids])), inputs, finish, encode, fixed)


MODES = {"frozen": frozen, "finetuned": finetuned}


def mode_named(name):
    """The function of a mode: a name of MODES or a range of layers; ValueError for another."""
    if is_range(name):
        return layer_range(name)
    if name not in MODES:
        raise ValueError(f"unknown mode {name!r}, known: {', '.join(MODES)}, and ranges of layers such as 18:139")
    return MODES[name]


@torch.no_grad()
def features(network, images, change=None, batch=32):
    """(k, width) f4: the network's features of images (k, 3, h, w) in 0..1, each batch first given to `change`."""
    found = []
    for part in images.split(batch):
        with enough_memory(), mixed(images.device):
            found.append(network.features(normalise(part if change is None else change(part))).float())
    return torch.cat(found)
