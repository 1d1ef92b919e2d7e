"""One budget of cores for all processes of a run: an item is worked on while its process holds one of them.

Workers of several stages then take no more processors than there are. A core is a locked file, which the system frees
when its process is killed.
"""

import os
import random
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout
from joblib import cpu_count

FOLDER = "HAPTIC_GLANCE_CORES"  # names the folder of the locks; without it every process takes what it wants
POLL = 0.02  # seconds between two looks for a free core


@contextmanager
def budget(folder: Path) -> Iterator[None]:
    """Inside the block, this process and those that it starts share the cores of the machine."""
    folder.mkdir(parents=True, exist_ok=True)
    os.environ[FOLDER] = str(folder.resolve())
    try:
        yield
    finally:
        del os.environ[FOLDER]


@contextmanager
def core() -> Iterator[None]:
    """Waits for a free core of the budget and holds it inside the block; without a budget it does nothing."""
    folder = os.environ.get(FOLDER)
    if folder is None:
        yield
        return
    locks = [FileLock(Path(folder) / str(number)) for number in range(cpu_count())]
    while True:
        for lock in random.sample(locks, len(locks)):  # so that not all wait for the first one
            try:
                with lock.acquire(timeout=0):
                    yield
                    return
            except Timeout:
                continue
        time.sleep(POLL)
