"""The device that a network runs on: the CPU, or a CUDA card where there is one."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

import torch

DEVICES = ("auto", "cpu", "cuda")
REMEDY = (
    "take a smaller batch, smaller images or fewer cached copies (the stage's `batch`, `size` and `copies`), or fewer"
    " workers (parallel.workers)"
)
_bfloat16 = ContextVar("whether networks compute in bfloat16 on a CPU", default=False)


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
    """A context in which a CUDA card computes in half precision where that is safe, and a CPU as `on_cpu` says."""
    if device.type == "cuda":
        return torch.autocast("cuda", dtype=torch.float16)
    return torch.autocast("cpu", dtype=torch.bfloat16, enabled=_bfloat16.get())


@contextmanager
def on_cpu(bfloat16: bool) -> Iterator[None]:
    """A context in which networks compute in bfloat16 on a CPU where that is safe, or in float32.

    A setting and never the machine decides it, so that equal settings give equal rows. A CPU with instructions of its
    own for bfloat16 takes half the time for large convolutions; another one takes longer.
    """
    before = _bfloat16.set(bfloat16)
    try:
        yield
    finally:
        _bfloat16.reset(before)


def precision(device: torch.device, bfloat16: bool = False) -> str:
    """The name of the numbers in which networks compute on a device, on a CPU within `on_cpu(bfloat16)`."""
    if device.type == "cuda":
        return "float16"
    return "bfloat16" if bfloat16 else "float32"


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
