"""Processor time of a block: what it would take on a quiet core, whatever else runs on the machine."""

import time

from stages.kit import Stopwatch


class CoreSeconds(Stopwatch):
    """A Stopwatch of the seconds that this process computes; with one thread, the seconds of one core."""

    def __enter__(self) -> "CoreSeconds":
        self._start = time.process_time()
        return self

    def __exit__(self, *_: object) -> None:
        self.seconds = time.process_time() - self._start
