"""The parallel map with a progress bar, by joblib; its result never depends on the workers."""

import functools
import os
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from multiprocessing import resource_tracker
from typing import Any, TypeVar

from joblib import Parallel, cpu_count, delayed, parallel_config
from joblib.externals.loky import process_executor
from joblib.externals.loky.backend import resource_tracker as loky_tracker
from threadpoolctl import threadpool_limits
from tqdm import tqdm

from haptic_glance.base.errors import interrupts_wait
from haptic_glance.base.extras import from_extra

BACKENDS = ("loky", "sequential", "dask")  # processes here, one item after the other, or a cluster
SCHEDULER = "DASK_SCHEDULER"  # the environment variable that holds the address of a cluster's scheduler
GROWTH = 600_000_000  # bytes by which a worker may grow; joblib allows half, and each new one imports for seconds
WATCH = 1.0  # seconds between two looks of a worker at the process that it works for
Item = TypeVar("Item")
Result = TypeVar("Result")


def parallel_map(
    function: Callable[[Item], Result],
    items: Iterable[Item],
    desc: str,
    backend: str = "loky",
    workers: int = -1,
) -> list[Result]:
    """[function(item) for item in items], in parallel, in the order of the items. backend, workers: as of `finished`.

    An exception of an item ends the map: functions that may meet bad input return the reason instead.
    """
    listed = list(items)
    results = dict(_finished(function, listed, desc, backend, workers))
    return [results[number] for number in range(len(listed))]


def finished(
    function: Callable[[Item], Result],
    items: Sequence[Item],
    desc: str,
    backend: str = "loky",
    workers: int = -1,
) -> Iterator[tuple[Item, Result]]:
    """(item, function(item)) of all items as they finish, in any order, with a progress bar on a terminal.

    backend: `loky` (processes here), `sequential`, or `dask`: the cluster whose scheduler DASK_SCHEDULER names, else
    one of processes here. Its machines must share the folder of the run. workers: how many here, -1 for one a core.
    """
    return ((items[number], result) for number, result in _finished(function, items, desc, backend, workers))


def progress(items: Iterable[Item], desc: str, total: int | None = None) -> Iterable[Item]:
    """The items, with a progress bar on a terminal; silent elsewhere."""
    return tqdm(items, desc=desc, total=total, disable=not sys.stderr.isatty())


def _finished(function, items, desc, backend, workers) -> Iterable[tuple[int, Any]]:
    """(number of the item, result) of all items as they finish."""
    if backend == "sequential" or len(items) < 2:
        pairs: Any = (_numbered(function, *pair) for pair in enumerate(items))
    else:
        pairs = _pairs(function, items, backend, workers)
    return progress(pairs, desc, len(items))


def _pairs(function, items, backend, workers):
    # Caches make a worker grow; joblib then renews it between two items, loses none, and warns.
    warnings.filterwarnings("ignore", message="A worker stopped while some jobs")
    if backend == "dask":
        _client(workers)
    for tracker in (resource_tracker, loky_tracker):  # their start, inside the block, would let Ctrl-C through
        tracker.ensure_running()
    # Ctrl-C goes to all processes of a terminal: this one ends its workers, which would each print a traceback.
    work = functools.partial(_of_worker, function, os.getpid() if backend == "loky" else 0)
    with parallel_config(backend, n_jobs=-1 if backend == "dask" else workers), interrupts_wait():
        return Parallel(return_as="generator_unordered")(delayed(work)(*pair) for pair in enumerate(items))


@functools.cache
def _client(workers: int) -> Any:
    """The one client of this process, which joblib finds; its dashboard is named on stderr."""
    with from_extra():
        from distributed import Client

    if address := os.environ.get(SCHEDULER):
        client = Client(address)
    else:
        local: Any = {"threads_per_worker": 1, "memory_limit": 0, "dashboard_address": "127.0.0.1:0"}
        client = Client(n_workers=cpu_count() if workers < 1 else workers, **local)
    print(f"dask: dashboard {client.dashboard_link}", file=sys.stderr)
    return client


def _of_worker(function, parent, number, item):
    process_executor._MAX_MEMORY_LEAK_SIZE = GROWTH  # of this worker, which looks at it after each item
    if parent not in (0, os.getpid()):  # with one worker, joblib works in this process
        _end_with(parent)
    return _numbered(function, number, item)


def _numbered(function, number, item):
    with threadpool_limits(1):  # as workers of joblib have it: spinning threads would count as its cost
        return number, function(item)


@functools.cache
def _end_with(parent: int) -> None:
    """Ends this worker soon after its parent, which a signal may have ended without a chance to say so."""

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(WATCH)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
