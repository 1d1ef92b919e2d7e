"""A hybrid network in a file: arrays and a header that names the architecture; nothing is pickled."""

import json
import zipfile
from pathlib import Path

import numpy as np
import torch

from stages.kit.files import read_arrays, write_arrays
from stages.networks import build

from .hybrid import SENSES, HybridNet
from .smaller import KINDS

ARCHITECTURE = "hybrid_mobilenet_v2"
HEADER = "header"  # the array with the JSON text


def save(path, network, classes, kind="float32"):
    """Writes a HybridNet to an .npz with its header: architecture, senses, classes, middle, kind of numbers.

    classes: their names, in the order of both heads. kind: `float32` keeps every bit; `float16` and `int8` are the
    smaller ones of stages.transfer.smaller. Equal networks give equal bytes. Raises ValueError for another number of
    names than the heads have classes, or an unknown kind.
    """
    if network.classes != (len(classes),) * 2:
        raise ValueError(f"{len(classes)} names of classes for heads of {network.classes} classes")
    if kind not in KINDS:
        raise ValueError(f"unknown kind of numbers {kind!r}, known: {', '.join(KINDS)}")
    header = {"architecture": ARCHITECTURE, "senses": SENSES, "classes": list(classes), "middle": network.middle}
    arrays = KINDS[kind].pack(state_arrays(network))
    write_arrays(path, **{HEADER: np.array(json.dumps(header | {"kind": kind}))}, **arrays)


def load(path):
    """(HybridNet, names of its classes) of a file that `save` wrote; of a smaller kind with its weights unpacked.

    Raises ValueError, saying what was found, for a file that is none, is damaged or holds another architecture.
    """
    header, arrays = _read(path)
    try:
        start, stop = header["middle"]
        classes = [str(name) for name in header["classes"]]
        network = build("mobilenet_v2", len(classes), "random", 0)
        hybrid = HybridNet(network, network, (start, stop))
        state = {key: torch.from_numpy(value) for key, value in KINDS[header["kind"]].unpack(arrays).items()}
        hybrid.load_state_dict(state)
    except (KeyError, TypeError, ValueError, RuntimeError) as error:
        raise ValueError(f"{path} does not hold the network its header names: {str(error).splitlines()[0]}") from None
    return hybrid, classes


def state_arrays(network):
    """Dict of contiguous arrays of a module's state, without the counters that nothing in evaluation mode reads."""
    state = {key: value for key, value in network.state_dict().items() if not key.endswith("num_batches_tracked")}
    return {key: np.ascontiguousarray(value.cpu().numpy()) for key, value in state.items()}


def _read(path):
    if Path(path).exists() and not zipfile.is_zipfile(path):
        raise ValueError(f"{path} holds no hybrid network: it is no .npz file")
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
