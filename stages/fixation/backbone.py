"""The last feature maps of the networks, computed once per object and cached."""

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np
import torch
from torch.fx.experimental.optimization import fuse

from haptic_glance.base.files import read_arrays, sha256, write_arrays
from haptic_glance.base.timing import Stopwatch
from haptic_glance.deep import Network, build, recalibrate
from haptic_glance.deep.device import choose_device, device_of, explain_out_of_memory, mixed_precision
from stages.kit.repeatable import repeatable

from .options import MODES, Method
from .pictures import network_inputs, read_pictures
from .schema import Params

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
        few = objects[:: -(-len(objects) // CALIBRATION_PICTURES)]
        images = network_inputs(np.stack([read_pictures(made, one)[0][0] for one in few]))
        recalibrate(network, lambda ids: images[ids], np.arange(len(few)))
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
        read_state(made, method.name, network)
    network.convolutions = fuse(network.convolutions)  # type: ignore[assignment]  # a graph of the same layers
    return network


@torch.inference_mode()
def last_maps(network: Network, pictures: np.ndarray) -> np.ndarray:
    """(v, C, i, j) f4: the last feature maps of grey pictures (v, h, w) u1."""
    device, found = device_of(network), []
    for k in range(0, len(pictures), BATCH):
        with explain_out_of_memory(), mixed_precision(device):
            found.append(network.convolutions(network_inputs(pictures[k : k + BATCH], device)).float().cpu().numpy())
    return np.concatenate(found)


def read_maps(folder: Path, method: str, name: str) -> tuple[np.ndarray, float]:
    """(the maps (v, C, i, j) f2, their seconds)."""
    stored = read_arrays(folder / ".maps" / method / f"{name}.npz")
    return stored["maps"], float(stored["seconds"])


def read_pooled(folder: Path, method: str, name: str) -> np.ndarray:
    """(v, C) f4: the mean of each map."""
    return read_arrays(folder / ".pooled" / method / f"{name}.npz")["pooled"]


def state_path(folder: Path, name: str) -> Path:
    """Where the weights of a network are stored for the workers."""
    return folder / ".networks" / f"{name}.npz"


def write_state(folder: Path, name: str, network: Network) -> None:
    """Stores a network's weights for the workers."""
    state = {key: np.ascontiguousarray(value.cpu().numpy()) for key, value in network.state_dict().items()}
    write_arrays(state_path(folder, name), **state)


def read_state(folder: Path, name: str, network: Network) -> None:
    """Loads the stored weights into a network."""
    stored = read_arrays(state_path(folder, name))
    network.load_state_dict({key: torch.as_tensor(value) for key, value in stored.items()})
