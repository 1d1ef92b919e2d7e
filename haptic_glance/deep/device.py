"""The device that runs a network (CPU or CUDA), and the cost of the network per image."""

import copy
import os
import statistics
import time
from collections.abc import Iterator
from contextlib import contextmanager

import torch
from torch.utils.flop_counter import FlopCounterMode

from .network import count_parameters


@contextmanager
def repeatable(seed: int) -> Iterator[None]:
    """One thread, deterministic algorithms and a fixed seed, all put back at the end.

    Sums in another order round differently and training blows the difference up, so that a result would depend on
    the number of threads; trainings run side by side as processes instead.
    """
    threads, strict = torch.get_num_threads(), torch.get_deterministic_debug_mode()
    torch.set_num_threads(1)
    torch.set_deterministic_debug_mode("error")  # the same as use_deterministic_algorithms, which loads the compiler
    try:
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(seed)
            yield
    finally:
        torch.set_num_threads(threads)
        torch.set_deterministic_debug_mode(strict)


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


RUNS = 9  # timed runs, of which the median is taken
WARM_UPS = 2  # runs before the timed ones


@torch.no_grad()
def cost(network: torch.nn.Module, size: int) -> dict[str, float]:
    """dict(parameters, operations, milliseconds) of a network for one image (1, 3, size, size).

    operations: multiply-adds of convolutions and matrix products, as papers count them. Torch's counter counts the
    multiplication and the addition separately, so this is half its number. Normalisation, activation and pooling are
    not counted. milliseconds: the median of RUNS passes in evaluation mode on one thread of the CPU, whatever the
    network's device. It is the thread's own time, which excludes waiting for other processes and equals wall time on an
    idle machine. The network is unchanged. Raises ValueError for a size below 1 or one that the network cannot take.
    """
    if size < 1:
        raise ValueError(f"the side of the image must be 1 pixel or more, got {size}")
    clone = copy.deepcopy(network).cpu().eval()
    image = torch.zeros(1, 3, size, size).contiguous(memory_format=torch.channels_last)
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        with FlopCounterMode(display=False) as counter:
            clone(image)
        milliseconds = _milliseconds(lambda: clone(image))
    except RuntimeError as error:
        raise ValueError(f"the network cannot take an image of 3 x {size} x {size}: {error}") from None
    finally:
        torch.set_num_threads(threads)
    operations = counter.get_total_flops() // 2
    return {"parameters": count_parameters(network), "operations": operations, "milliseconds": milliseconds}


def _milliseconds(run):
    times = []
    for _ in range(WARM_UPS + RUNS):
        start = time.thread_time()
        run()
        times.append(1000 * (time.thread_time() - start))
    return statistics.median(times[WARM_UPS:])
