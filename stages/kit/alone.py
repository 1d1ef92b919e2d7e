"""One run at a time in one place; a killed run leaves the place free."""

import fcntl
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def alone(path: Path, who: str) -> Iterator[None]:
    """Inside the block no other process is in a block of the same lock file; a second one says so, and waits.

    who: names the waiting run on the screen. The system frees the lock when its process and all forks of it have ended.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    lock = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)  # not filelock, which lets go of it in forked processes
    try:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            print(f"{who}: waits for another run of the same to end", file=sys.stderr)
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield
        fcntl.flock(lock, fcntl.LOCK_UN)
    finally:
        os.close(lock)
