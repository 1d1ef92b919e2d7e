"""Where a network runs: the processor, or a graphics card where there is one."""

import os
from contextlib import contextmanager

import torch

DEVICES = ("auto", "cpu", "cuda")
REMEDY = "take a smaller batch or smaller images (the stage's `batch` and `size`) or fewer workers (parallel.workers)"


def choose(name="auto"):
    """The torch.device of a name: `auto` takes a CUDA card where there is one; ValueError for one that is not there.

    A card has no deterministic form of some steps (pooling, for one): from here on torch warns of these and goes on.
    """
    if name not in DEVICES:
        raise ValueError(f"unknown device {name!r}, known: {', '.join(DEVICES)}")
    if name == "cuda" and not torch.cuda.is_available():
        raise ValueError("device cuda: torch finds no CUDA card here; take auto or cpu")
    device = torch.device("cuda" if name != "cpu" and torch.cuda.is_available() else "cpu")
    if device.type == "cuda":
        os.environ.setdefault("CUBLAS_WORKSPACE_CONFIG", ":4096:8")  # else deterministic sums are refused there
        torch.use_deterministic_algorithms(torch.are_deterministic_algorithms_enabled(), warn_only=True)
    return device


def device_of(module):
    """Where the parameters of a module lie."""
    return next(module.parameters()).device


def mixed(device):
    """The context in which a CUDA card computes in half precision where that is safe; on a processor nothing."""
    return torch.autocast(device.type, dtype=torch.float16, enabled=device.type == "cuda")


@contextmanager
def enough_memory():
    """Turns errors of too little memory into a ValueError that names the remedies; a context and a decorator."""
    try:
        yield
    except (torch.OutOfMemoryError, MemoryError) as error:
        raise ValueError(f"too little memory: {REMEDY}") from error
    except RuntimeError as error:
        if "can't allocate memory" not in str(error):  # what the processor's allocator says
            raise
        raise ValueError(f"too little memory: {REMEDY}") from error
