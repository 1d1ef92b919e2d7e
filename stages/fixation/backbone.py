"""The last feature maps of the networks, computed once per object and cached."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch

from stages.kit import Stopwatch
from stages.kit.files import read_arrays, write_arrays
from stages.kit.repeatable import repeatable
from stages.networks import Network, build, recalibrate
from stages.networks.device import choose_device, device_of, explain_out_of_memory, mixed_precision

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
        if any(isinstance(layer, torch.nn.BatchNorm2d) for layer in network.modules()):
            recalibrate(network, lambda ids: images[ids], np.arange(len(few)))
    write_state(folder, name, network)
    return []


def compute_maps(name: str, folder: Path, made: Path, method: Method, settings: Params, seed: int) -> list[dict]:
    """Stores the maps of all views of one object as float16; returns a row with its cost.

    made: the folder of the pictures and, of a random method, of its network.
    """
    pictures, _ = read_pictures(made, name)
    with repeatable(seed):
        network = build(method.network, 2, MODES[method.mode], seed, settings.source)
        if method.mode == "random":
            read_state(made, method.name, network)
        with Stopwatch() as watch:
            maps = last_maps(network.to(choose_device(settings.device)), pictures)
    pooled = maps.mean(axis=(2, 3), dtype=np.float32)
    write_arrays(folder / ".pooled" / method.name / f"{name}.npz", pooled=pooled)
    half = maps.clip(-LARGEST, LARGEST).astype(np.float16)
    write_arrays(folder / ".maps" / method.name / f"{name}.npz", maps=half, seconds=watch.seconds)
    row = {"item": name, "method": method.name, "metric": "views"}
    return [row | {"value": len(pictures), "seconds": watch.seconds}]


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


def write_state(folder: Path, name: str, network: Network) -> None:
    """Stores a network's weights for the workers."""
    state = {key: np.ascontiguousarray(value.cpu().numpy()) for key, value in network.state_dict().items()}
    write_arrays(folder / ".networks" / f"{name}.npz", **state)


def read_state(folder: Path, name: str, network: Network) -> None:
    """Loads the stored weights into a network."""
    stored = read_arrays(folder / ".networks" / f"{name}.npz")
    network.load_state_dict({key: torch.as_tensor(value) for key, value in stored.items()})
