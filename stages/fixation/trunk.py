"""Mode `last_block`: all before the last block stays as it was, so that its maps are computed once (T3.3.2)."""

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np
import torch
from torch.fx.experimental.optimization import fuse

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep import build, normalise, recalibrate
from haptic_glance.deep.device import choose_device, device_of, explain_out_of_memory
from haptic_glance.deep.images import Transform
from haptic_glance.deep.modes import Task
from haptic_glance.deep.network import Network
from stages.kit.repeatable import repeatable

from .backbone import BATCH, LARGEST
from .options import LAST_BLOCK, MODES, Method
from .pictures import augmentation, read_pictures, to_images
from .schema import Params


class Tail(Network):
    """The last block of a network and what follows it: from the trunk's maps (b, C, i, j) to scores (b, k)."""

    def __init__(self, network: Network, start: int) -> None:
        torch.nn.Module.__init__(self)
        self.convolutions, self.pool, self.head = network.convolutions[start:], network.pool, network.head

    def forward(self, images: torch.Tensor) -> torch.Tensor:  # maps of the trunk instead of images
        return self.classify(self.convolutions(images))


def cache_trunk(name: str, folder: Path, made: Path, method: Method, settings: Params, seed: int) -> list[dict]:
    """Stores the trunk's maps of all views of one object, and of one augmented copy of each; returns no rows.

    made: the folder of the pictures.
    """
    pictures, _ = read_pictures(made, name)
    with repeatable(int(rng(seed, f"{name} augmented").integers(2**31))):
        trunk = trunk_of(method, settings.source, seed).to(choose_device(settings.device))
        with Stopwatch() as once:
            plain = trunk_maps(trunk, pictures, lambda images: images)
        with Stopwatch() as again:
            augmented = trunk_maps(trunk, pictures, augmentation())
    write_arrays(
        folder / ".trunk" / method.name / f"{name}.npz",
        maps=np.stack([plain, augmented]), seconds=once.seconds, more=again.seconds,
    )  # fmt: skip
    return []


@lru_cache(maxsize=1)  # a worker looks at many objects with one network
def trunk_of(method: Method, source: str, seed: int) -> torch.nn.Module:
    """The layers of a network before its last block, their normalisations folded into the convolutions."""
    network = build(method.network, 2, MODES[method.mode], seed, source)
    return fuse(network.convolutions[: LAST_BLOCK[method.network]])


@torch.inference_mode()
def trunk_maps(trunk: torch.nn.Module, pictures: np.ndarray, change: Transform) -> np.ndarray:
    """(v, C, i, j) f2: the trunk's maps of grey pictures (v, h, w) u1, first passed to `change`."""
    device, found = device_of(trunk), []
    for k in range(0, len(pictures), BATCH):
        with explain_out_of_memory():
            maps = trunk(normalise(change(to_images(pictures[k : k + BATCH], device))))
            found.append(maps.clamp(-LARGEST, LARGEST).half().cpu().numpy())
    return np.concatenate(found)


def read_trunk(made: Path, method: str, objects: Sequence[str]) -> tuple[torch.Tensor, float, float]:
    """((2, n, C, i, j) f2 maps of the pictures of the objects and of their augmented copies, seconds of either)."""
    parts = [read_arrays(made / ".trunk" / method / f"{name}.npz") for name in objects]
    maps = np.concatenate([part.pop("maps") for part in parts], axis=1)
    once, again = (sum(float(part[key]) for part in parts) for key in ("seconds", "more"))
    return torch.from_numpy(maps), once, again


def cached_task(network: Network, method: Method, maps: torch.Tensor) -> Task:
    """The Task to train the last block on cached maps (2, n, C, i, j), each step drawing plain or augmented ones."""
    tail, device = Tail(network, LAST_BLOCK[method.network]).requires_grad_(True), device_of(network)

    def chosen(copies, ids):
        return maps[copies, torch.as_tensor(ids)].to(device).float().contiguous(memory_format=torch.channels_last)

    def plain(ids):
        return chosen(0, ids)

    def drawn(ids):
        return chosen(torch.randint(len(maps), (len(ids),)), ids)

    def finish(model, ids):
        recalibrate(model, plain, ids, BATCH)

    return Task(tail, drawn, plain, finish, torch.nn.Identity())
