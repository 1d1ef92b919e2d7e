"""A hybrid network in a file: arrays and a header that names the architecture; nothing is pickled."""

import json
import zipfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import torch

from stages.kit.files import read_arrays, write_arrays
from stages.networks import build

from .hybrid import SENSES, HybridNet
from .precision import PRECISIONS

ARCHITECTURE = "hybrid_mobilenet_v2"
HEADER = "header"  # the array with the JSON text


def save(path: Path, network: HybridNet, classes: Sequence[str], precision: str = "float32") -> None:
    """Writes a HybridNet to an .npz with a header: architecture, senses, classes, middle, precision.

    classes: their names, in the order of both heads. precision: one of stages.transfer.precision.PRECISIONS; `float32`
    is exact. Equal networks give equal bytes. Raises ValueError for another number of names than the heads have
    classes, or an unknown precision.
    """
    if network.classes != (len(classes),) * 2:
        raise ValueError(f"{len(classes)} names of classes for heads of {network.classes} classes")
    if precision not in PRECISIONS:
        raise ValueError(f"unknown precision {precision!r}, known: {', '.join(PRECISIONS)}")
    header = {"architecture": ARCHITECTURE, "senses": SENSES, "classes": list(classes), "middle": network.middle}
    arrays = PRECISIONS[precision].pack(state_arrays(network))
    write_arrays(path, **{HEADER: np.array(json.dumps(header | {"kind": precision}))}, **arrays)


def load(path: Path) -> tuple[HybridNet, list[str]]:
    """(HybridNet, names of its classes) from a file that `save` wrote, with the weights unpacked to float32.

    Raises ValueError for another file, a damaged one or another architecture.
    """
    header, arrays = _read(path)
    try:
        start, stop = header["middle"]
        classes = [str(name) for name in header["classes"]]
        network = build("mobilenet_v2", len(classes), "random", 0)
        hybrid = HybridNet(network, network, (start, stop))
        state = {key: torch.from_numpy(value) for key, value in PRECISIONS[header["kind"]].unpack(arrays).items()}
        hybrid.load_state_dict(state)
    except (KeyError, TypeError, ValueError, RuntimeError) as error:
        raise ValueError(f"{path} does not hold the network its header names: {str(error).splitlines()[0]}") from None
    return hybrid, classes


def state_arrays(network: torch.nn.Module) -> dict[str, np.ndarray]:
    """The state of a module as contiguous arrays, without the batch counters, which evaluation mode does not use."""
    state = {key: value for key, value in network.state_dict().items() if not key.endswith("num_batches_tracked")}
    return {key: np.ascontiguousarray(value.cpu().numpy()) for key, value in state.items()}


def _read(path):
    if Path(path).exists() and not zipfile.is_zipfile(path):
        raise ValueError(f"{path} holds no hybrid network: it is not an .npz file")
    try:
        arrays = read_arrays(path)
        header = json.loads(str(arrays.pop(HEADER)))
        found = header["architecture"]
    except FileNotFoundError:
        raise
    except (zipfile.BadZipFile, KeyError, TypeError, ValueError, OSError, EOFError) as error:
        raise ValueError(f"{path} holds no hybrid network, or is damaged: {error}") from None
    if found != ARCHITECTURE:
        raise ValueError(f"{path} holds a network of architecture {found!r}; {ARCHITECTURE!r} is needed")
    return header, arrays
