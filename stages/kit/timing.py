"""Wall time of a block."""

import time


class Stopwatch:
    """`with Stopwatch() as watch: ...` then `watch.seconds`: the block's wall time."""

    def __enter__(self):
        self._start = time.perf_counter()
        return self

    def __exit__(self, *_):
        self.seconds = time.perf_counter() - self._start
