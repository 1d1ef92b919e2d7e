"""Makes a training in torch repeatable."""

from collections.abc import Iterator
from contextlib import contextmanager

import torch


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
