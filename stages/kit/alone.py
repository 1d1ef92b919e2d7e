"""One run at a time in one place; a killed run leaves the place free."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from filelock import FileLock, Timeout


@contextmanager
def alone(path: Path, who: str) -> Iterator[None]:
    """Inside the block no other process is in a block of the same lock file; a second one says so, and waits.

    who: names the waiting run on the screen. The system frees the lock when its process and all forks of it have ended.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    lock = FileLock(path)
    try:
        lock.acquire(timeout=0)
    except Timeout:
        print(f"{who}: waits for another run of the same to end", file=sys.stderr)
        lock.acquire()
    try:
        yield
    finally:
        lock.release()
