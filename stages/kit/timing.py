"""Wall time of a block."""

import time


class Stopwatch:
    """`with Stopwatch() as watch: ...` then `watch.seconds`: the block's wall time."""

    seconds: float

    def __enter__(self) -> "Stopwatch":
        self._start = time.perf_counter()
        return self

    def __exit__(self, *_: object) -> None:
        self.seconds = time.perf_counter() - self._start
