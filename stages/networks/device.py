"""The device that a network runs on: the CPU, or a CUDA card where there is one."""

import os
from collections.abc import Iterator
from contextlib import contextmanager

import torch

DEVICES = ("auto", "cpu", "cuda")
REMEDY = (
    "take a smaller batch, smaller images or fewer cached copies (the stage's `batch`, `size` and `copies`), or fewer"
    " workers (parallel.workers)"
)


def choose_device(name: str = "auto") -> torch.device:
    """The torch.device of a name of DEVICES: `auto` is a CUDA card where there is one, else the CPU.

    Some operations, pooling for one, have no deterministic form on a card: torch then warns of them and continues.
    Raises ValueError for an unknown name, or `cuda` without a card.
    """
    if name not in DEVICES:
        raise ValueError(f"unknown device {name!r}, known: {', '.join(DEVICES)}")
    if name == "cuda" and not torch.cuda.is_available():
        raise ValueError("device cuda: torch finds no CUDA card here; take auto or cpu")
    device = torch.device("cuda" if name != "cpu" and torch.cuda.is_available() else "cpu")
    if device.type == "cuda":
        os.environ.setdefault("CUBLAS_WORKSPACE_CONFIG", ":4096:8")  # without it CUDA refuses deterministic sums
        torch.use_deterministic_algorithms(torch.are_deterministic_algorithms_enabled(), warn_only=True)
    return device


def device_of(module: torch.nn.Module) -> torch.device:
    """The device of a module's parameters."""
    return next(module.parameters()).device


def mixed_precision(device: torch.device) -> torch.autocast:
    """A context in which a CUDA card computes in half precision where that is safe.

    A CPU computes in single precision: in bfloat16 it takes two thirds of the time where the processor has instructions
    for it, and three times as long where it has none, and equal settings shall give equal rows.
    """
    return torch.autocast(device.type, dtype=torch.float16, enabled=device.type == "cuda")


def precision(device: torch.device) -> str:
    """The name of the numbers in which networks compute on a device."""
    return "float16" if device.type == "cuda" else "float32"


@contextmanager
def explain_out_of_memory() -> Iterator[None]:
    """A context manager and decorator that turns out-of-memory errors into a ValueError that names the remedies."""
    try:
        yield
    except (torch.OutOfMemoryError, MemoryError) as error:
        raise ValueError(f"too little memory: {REMEDY}") from error
    except RuntimeError as error:
        if "can't allocate memory" not in str(error):  # the message of the CPU's allocator
            raise
        raise ValueError(f"too little memory: {REMEDY}") from error
