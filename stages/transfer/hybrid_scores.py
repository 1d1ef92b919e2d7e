"""What a hybrid network answers, a few images at a time, and the rows that say so."""

import torch

from stages.networks.device import device_of, enough_memory

from .hybrid import SENSES, Scores, join

BATCH = 64  # images at a time


def lone(images, kind):
    """Six channels of one sense's images (k, 3, h, w); the other is absent."""
    return join(images, None) if kind == 0 else join(None, images)


def scored(hybrid, images, kind):
    """(n, classes) f4 numpy: the scores of one sense's head for its images (n, 3, h, w), the other being absent."""
    return in_parts(lambda part: hybrid(lone(part, kind))[kind], images, device_of(hybrid))


@torch.no_grad()
def in_parts(function, images, device):
    """function(images), a tensor or Scores, as numpy; computed on the device, a few images at a time."""
    with enough_memory():
        found = [function(part.to(device)) for part in images.split(BATCH)]
    if isinstance(found[0], Scores):
        return Scores(*(torch.cat(part).cpu().numpy() for part in zip(*found, strict=True)))
    return torch.cat(found).cpu().numpy()


def row(method, metric, value, kind=None, seconds=None):
    """A row; kind: which sense it is of, None for the whole."""
    sense = None if kind is None else SENSES[kind]
    return {"method": method, "sense": sense, "metric": metric, "value": value, "seconds": seconds}
