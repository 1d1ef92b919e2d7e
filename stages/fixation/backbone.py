"""The networks' last maps, computed once for each object and cached."""

import numpy as np
import torch

from stages.kit import Stopwatch
from stages.kit.files import read_arrays, write_arrays
from stages.kit.repeatable import repeatable
from stages.networks import build, settle
from stages.networks.device import choose, device_of, enough_memory, mixed

from .options import MODES, method_named
from .pictures import inputs, read_pictures

BATCH = 16
SETTLING = 64  # pictures that give an untrained network's normalisation layers their statistics
FULL = 60_000  # largest value stored: float16 ends at 65,504


def prepare(item, folder, settings, objects, seed):
    """Makes the untrained network of a random method (`METHOD@network`), and gives it its statistics; no rows."""
    method = method_named(item.partition("@")[0])
    with repeatable(seed):
        network = build(method.network, 2, MODES[method.mode], seed, settings.source)
        few = objects[:: -(-len(objects) // SETTLING)]
        images = inputs(np.stack([read_pictures(folder, name)[0][0] for name in few]))
        if any(isinstance(layer, torch.nn.BatchNorm2d) for layer in network.modules()):
            settle(network, lambda ids: images[ids], np.arange(len(few)))
    write_state(folder, method.name, network)
    return []


def look(item, folder, settings, seed):
    """Computes the maps of all views of one object (`METHOD@NAME`), float16; a row of what that costs."""
    method, name = method_named(item.partition("@")[0]), item.partition("@")[2]
    pictures, _ = read_pictures(folder, name)
    with repeatable(seed):
        network = build(method.network, 2, MODES[method.mode], seed, settings.source)
        if method.mode == "random":
            read_state(folder, method.name, network)
        with Stopwatch() as watch:
            maps = maps_of(network.to(choose(settings.device)), pictures)
    pooled = maps.mean(axis=(2, 3), dtype=np.float32)
    write_arrays(folder / ".pooled" / method.name / f"{name}.npz", pooled=pooled)
    half = maps.clip(-FULL, FULL).astype(np.float16)
    write_arrays(folder / ".maps" / method.name / f"{name}.npz", maps=half, seconds=watch.seconds)
    row = {"object": name, "method": method.name, "task": None, "view": None, "metric": "views"}
    return [row | {"value": len(pictures), "seconds": watch.seconds}]


@torch.inference_mode()
def maps_of(network, pictures):
    """(v, C, i, j) f4: the last maps of grey pictures (v, h, w) u1; VGG16's 14 x 14 are before its last pooling."""
    device, found = device_of(network), []
    for k in range(0, len(pictures), BATCH):
        with enough_memory(), mixed(device):
            found.append(network.convolutions(inputs(pictures[k : k + BATCH], device)).float().cpu().numpy())
    return np.concatenate(found)


def read_maps(folder, method, name):
    """((v, C, i, j) f2, seconds that they took)."""
    stored = read_arrays(folder / ".maps" / method / f"{name}.npz")
    return stored["maps"], float(stored["seconds"])


def read_pooled(folder, method, name):
    """(v, C) f4: each map's mean."""
    return read_arrays(folder / ".pooled" / method / f"{name}.npz")["pooled"]


def write_state(folder, name, network):
    """Keeps a network's weights for the workers."""
    state = {key: np.ascontiguousarray(value.cpu().numpy()) for key, value in network.state_dict().items()}
    write_arrays(folder / ".networks" / f"{name}.npz", **state)


def read_state(folder, name, network):
    """Gives a network the weights kept."""
    stored = read_arrays(folder / ".networks" / f"{name}.npz")
    network.load_state_dict({key: torch.as_tensor(value) for key, value in stored.items()})
