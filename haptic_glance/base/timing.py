"""Seconds of a block: of the processor, for rows; on the wall, for people who wait."""

import platform
import re
import time
from functools import cache
from pathlib import Path

CLOCK = "processor"  # of the seconds that rows get from a Stopwatch
WALL = "wall time beside other workers, 2 cores, x86_64"  # of rows without a clock, which were measured before


@cache
def clock() -> str:
    """CLOCK and the model of this machine's processor."""
    described = Path("/proc/cpuinfo")
    models = re.findall(r"^model name\s*: (.+)", described.read_text(), re.M) if described.exists() else []
    return f"{CLOCK}, {(*models, platform.processor(), platform.machine())[0]}"


class Stopwatch:
    """`with Stopwatch() as watch: ...` then `watch.seconds`: processor seconds of the block, whatever else runs.

    Threads of this process count together: stages compute with one thread a worker, and a renderer's threads belong to
    its cost.
    """

    seconds: float
    clock = staticmethod(time.process_time)

    def __enter__(self) -> "Stopwatch":
        self._start = self.clock()
        return self

    def __exit__(self, *_: object) -> None:
        self.seconds = self.clock() - self._start


class WallClock(Stopwatch):
    """The seconds that a person waits for the block."""

    clock = staticmethod(time.perf_counter)
