"""What of the network learns: the head alone on cached features, or every layer (T5.3)."""

from collections.abc import Callable
from dataclasses import dataclass

import torch

from .images import augmentation, normalise, to_images
from .network import settle


@dataclass(frozen=True)
class Task:
    """What a mode trains: the model, and what it is fed.

    training_inputs(ids) gives the augmented inputs of touches (b,) i8, drawn from torch's random numbers; inputs(ids)
    the plain ones, always the same; finish(model, ids) is what is left to do when training on the touches ids ends.
    """

    model: torch.nn.Module
    training_inputs: Callable[[torch.Tensor], torch.Tensor]
    inputs: Callable[[torch.Tensor], torch.Tensor]
    finish: Callable[[torch.nn.Module, torch.Tensor], None]


def frozen(network, imprints, size, copies):
    """The Task to train the head alone on what the frozen network makes of imprints (k, r, c).

    Nothing of the convolutions changes, and neither do the statistics of their normalisation: the network stays in
    evaluation mode. So each image's features are computed once and cached. Cached features cannot be augmented: a few
    augmented copies of each image (`copies`) are cached beside the plain one, and each step draws among them.
    """
    network.eval().convolutions.requires_grad_(False)
    images, moved = to_images(imprints, size), augmentation()
    plain = features(network, images, lambda part: part)
    cached = torch.stack([plain, *(features(network, images, moved) for _ in range(copies))])

    def drawn(ids):
        return cached[torch.randint(len(cached), (len(ids),)), ids]

    return Task(network.head, drawn, lambda ids: plain[ids], lambda head, ids: None)


def finetuned(network, imprints, size, copies):
    """The Task to train every layer on imprints (k, r, c), augmented anew at every step: no copies needed."""
    network.requires_grad_(True)
    images, moved = to_images(imprints, size), augmentation()

    def inputs(ids):
        return normalise(images[ids])

    return Task(
        network, lambda ids: normalise(moved(images[ids])), inputs, lambda model, ids: settle(model, inputs, ids)
    )


MODES = {"frozen": frozen, "finetuned": finetuned}


@torch.no_grad()
def features(network, images, change, batch=32):
    """(k, width): the network's features of images (k, 3, h, w) in 0..1, each batch first given to `change`."""
    return torch.cat([network.features(normalise(change(part))) for part in images.split(batch)])
