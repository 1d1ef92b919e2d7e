"""Pictures of objects as inputs of networks for photographs (T3.3.2), and the feature maps of the networks.

The last feature maps are computed once per object and cached. In mode `last_block` all before the last block stays as
it was, so that its maps are computed once, too.
"""

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
import torch
from kornia import augmentation as kornia_augmentation
from torch.fx.experimental.optimization import fuse

from haptic_glance.base.fetch import FetchError
from haptic_glance.base.files import read_arrays, read_mesh, sha256, write_arrays
from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep.device import choose_device, device_of, explain_out_of_memory, mixed_precision, repeatable
from haptic_glance.deep.images import Transform, normalise
from haptic_glance.deep.modes import Task
from haptic_glance.deep.network import Network, build, published_layers, recalibrate
from haptic_glance.look.views import render
from haptic_glance.look.weights.convexity import convexity

from . import Params
from .places import curvature_shares, eccentricity
from .tasks import viewpoint_sphere

DEGREES, SCALE = 20, (0.8, 1.2)  # random rotation and rescaling; T3.3.2 gives no range


def take_pictures(name: str, folder: Path, data: Path, settings: Params) -> list[dict]:
    """Stores the pictures of one object and measures its shape; returns one row per measure.

    The renderer `raster` draws them: it gives the same bytes on every machine.
    """
    mesh = read_mesh(data / "meshes" / f"{name}.npz")
    viewpoints, size = viewpoint_sphere(settings.parallels, settings.azimuths), (settings.size, settings.size)
    with Stopwatch() as watch:
        pictures = np.stack([render(mesh, viewpoint, size, "raster").rgb.mean(axis=2) for viewpoint in viewpoints])
    write_arrays(
        folder / ".pictures" / f"{name}.npz", pictures=np.rint(pictures).astype(np.uint8), seconds=watch.seconds
    )
    with Stopwatch() as watch:
        measures = {"convexity": convexity(mesh), "eccentricity": eccentricity(mesh)}
        measures |= dict(zip(("positive", "negative", "zero"), curvature_shares(mesh), strict=True))
    row = {"item": name, "method": "shape", "seconds": watch.seconds}
    return [row | {"metric": metric, "value": value} for metric, value in measures.items()]


def read_pictures(folder: Path, name: str) -> tuple[np.ndarray, float]:
    """(the pictures (v, size, size) u1, their seconds)."""
    arrays = read_arrays(folder / ".pictures" / f"{name}.npz")
    return arrays["pictures"], float(arrays["seconds"])


def to_images(pictures: np.ndarray, device: str | torch.device = "cpu") -> torch.Tensor:
    """(b, 3, h, w) f4 in 0..1 on a torch device: grey pictures (b, h, w) u1."""
    grey = torch.as_tensor(pictures, device=device).float() / 255
    return grey[:, None].expand(-1, 3, -1, -1)


def network_inputs(pictures: np.ndarray, device: str | torch.device = "cpu") -> torch.Tensor:
    """(b, 3, h, w) f4 normalised images of grey pictures (b, h, w) u1."""
    return normalise(to_images(pictures, device))


def augmentation() -> torch.nn.Module:
    """Random rotation and rescaling of images in 0..1 (T3.3.2), by torch's random numbers."""
    return kornia_augmentation.RandomAffine(degrees=DEGREES, scale=SCALE, p=1.0)


MODES = {  # mode -> the network's initial weights
    "frozen": "imagenet",  # the network keeps ImageNet's weights, a new head per task is trained
    "last_block": "imagenet",  # the last block and what follows it is trained, one network per task, on cached maps
    "finetuned": "imagenet",  # every layer is trained, one network per task
    "random": "random",  # the control: an untrained network, of which only the heads are trained
}
TRAINED = ("last_block", "finetuned")  # modes with a network per task
LAST_BLOCK = {  # network -> the first part of its last block, in the order of its convolutions
    "vgg16": 24,  # conv5_1
    "resnet50": 7,  # layer4
    "resnet101": 7,
    "mobilenet_v2": 17,
}


@dataclass(frozen=True)
class Method:
    """A network and the mode in which it is trained."""

    name: str
    network: str
    mode: str


def method_named(name: str) -> Method:
    """The Method of a name NETWORK-MODE; raises ValueError for a name without a known mode."""
    network, _, mode = name.rpartition("-")
    if not network or mode not in MODES:
        raise ValueError(f"{name!r} is not NETWORK-MODE with mode {', '.join(MODES)}")
    if mode == "last_block" and network not in LAST_BLOCK:
        raise ValueError(f"{name}: the last block is known of {', '.join(LAST_BLOCK)} alone")
    return Method(name, network, mode)


def check(settings: Params) -> None:
    """Raises ValueError for settings that cannot be run."""
    choose_device(settings.device)
    if settings.size < 32 or settings.folds < 2 or not (settings.penalties and settings.rates and settings.methods):
        raise ValueError(
            "fixation: size must be 32 or more, folds 2 or more, and penalties, rates and methods must not be empty"
        )


def available(settings: Params) -> tuple[list[Method], dict[str, str]]:
    """(methods that can run, dict of the others -> reason): methods without available weights are left out."""
    usable, missing = [], {}
    for method in [method_named(name) for name in dict.fromkeys(settings.methods)]:
        try:
            build(method.network, 2, MODES[method.mode], 0, settings.source)
            usable.append(method)
            if method.mode == "last_block" and not published_layers(method.network, settings.source):
                print(f"fixation: {method.name}: no package registry has ImageNet's weights of the fully connected "
                      "layers, they start at random: set fixation.source=download on a machine with a network",
                      file=sys.stderr)  # fmt: skip
        except FetchError as error:
            print(f"fixation: {method.name} is left out: {error}", file=sys.stderr)
            missing[method.name] = str(error)
    return usable, missing


BATCH = 16
CALIBRATION_PICTURES = 64  # for the statistics of an untrained network's normalisation layers
LARGEST = 60_000  # largest value stored: float16 ends at 65,504


def prepare_random_network(
    name: str, folder: Path, made: Path, method: Method, settings: Params, objects: Sequence[str], seed: int
) -> list[dict]:
    """Builds the untrained network of a random method, named `name`, and recalibrates it; returns no rows.

    made: the folder of the pictures; objects: all of them.
    """
    with repeatable(seed):
        network = build(method.network, 2, MODES[method.mode], seed, settings.source)
        sample = objects[:: -(-len(objects) // CALIBRATION_PICTURES)]
        images = network_inputs(np.stack([read_pictures(made, item)[0][0] for item in sample]))
        recalibrate(network, lambda ids: images[ids], np.arange(len(sample)))
    write_state(folder, name, network)
    return []


def compute_maps(name: str, folder: Path, made: Path, method: Method, settings: Params, seed: int) -> list[dict]:
    """Stores the maps of all views of one object as float16, with the seconds that they took; returns no rows.

    made: the folder of the pictures and, of a random method, of its network.
    """
    pictures, _ = read_pictures(made, name)
    state = sha256(state_path(made, method.name)) if method.mode == "random" else ""
    with repeatable(seed):
        network = folded_network(made, method, settings.source, seed, state).to(choose_device(settings.device))
        with Stopwatch() as watch:
            maps = last_maps(network, pictures)
    pooled = maps.mean(axis=(2, 3), dtype=np.float32)
    write_arrays(folder / ".pooled" / method.name / f"{name}.npz", pooled=pooled)
    half = maps.clip(-LARGEST, LARGEST).astype(np.float16)
    write_arrays(folder / ".maps" / method.name / f"{name}.npz", maps=half, seconds=watch.seconds)
    return []


@lru_cache(maxsize=1)  # a worker looks at many objects with one network
def folded_network(made: Path, method: Method, source: str, seed: int, state: str) -> Network:
    """The network of a frozen or random method, its normalisations folded into the convolutions before them.

    state: the hash of the stored weights of a random method, else empty.
    """
    network = build(method.network, 2, MODES[method.mode], seed, source)
    if state:
        arrays = read_arrays(state_path(made, method.name))
        network.load_state_dict({key: torch.as_tensor(value) for key, value in arrays.items()})
    network.convolutions = fuse(network.convolutions)  # type: ignore[assignment]  # a graph of the same layers
    return network


@torch.inference_mode()
def last_maps(network: Network, pictures: np.ndarray) -> np.ndarray:
    """(v, C, i, j) f4: the last feature maps of grey pictures (v, h, w) u1."""
    device, batches = device_of(network), []
    for k in range(0, len(pictures), BATCH):
        with explain_out_of_memory(), mixed_precision(device):
            batches.append(network.convolutions(network_inputs(pictures[k : k + BATCH], device)).float().cpu().numpy())
    return np.concatenate(batches)


def read_maps(folder: Path, method: str, name: str) -> tuple[np.ndarray, float]:
    """(the maps (v, C, i, j) f2, their seconds)."""
    arrays = read_arrays(folder / ".maps" / method / f"{name}.npz")
    return arrays["maps"], float(arrays["seconds"])


def state_path(folder: Path, name: str) -> Path:
    """The file of a network's weights, for the workers."""
    return folder / ".networks" / f"{name}.npz"


def write_state(folder: Path, name: str, network: Network) -> None:
    """Stores a network's weights for the workers."""
    state = {key: np.ascontiguousarray(value.cpu().numpy()) for key, value in network.state_dict().items()}
    write_arrays(state_path(folder, name), **state)


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
    device, batches = device_of(trunk), []
    for k in range(0, len(pictures), BATCH):
        with explain_out_of_memory():
            maps = trunk(normalise(change(to_images(pictures[k : k + BATCH], device))))
            batches.append(maps.clamp(-LARGEST, LARGEST).half().cpu().numpy())
    return np.concatenate(batches)


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
