"""The parallel map with a progress bar, whose result never depends on the workers, and one budget of cores for a run.

An item is worked on while its process holds a core of the budget, so that the workers of several stages take no more
processors than there are. A core is a locked file, which the system frees when its process is killed.
"""

import functools
import os
import random
import sys
import time
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing import resource_tracker
from pathlib import Path
from typing import Any, TypeVar

from filelock import FileLock, Timeout
from joblib import Parallel, cpu_count, delayed, parallel_config
from joblib.externals.loky import process_executor
from joblib.externals.loky.backend import resource_tracker as loky_tracker
from threadpoolctl import threadpool_limits
from tqdm import tqdm

from haptic_glance.base.errors import interrupts_wait

BACKENDS = ("loky", "sequential", "dask")  # processes here, one item after the other, or a cluster
GROWTH = 600_000_000  # bytes by which a worker may grow; joblib allows half, and each new one imports for seconds
Item = TypeVar("Item")
Result = TypeVar("Result")


@dataclass(frozen=True)
class Task:
    """One item of a map.

    name: for messages, another one for each item. value: what the function works on. files: {path below the root:
    SHA-256, empty where there is no such file} of all that it may read there. key: the hash of all that it comes from.
    """

    name: str
    value: Any
    files: Mapping[str, str] = field(default_factory=dict)
    key: str = ""


def parallel_map(
    function: Callable[[Item], Result],
    items: Iterable[Item],
    desc: str,
    backend: str = "loky",
    workers: int = -1,
) -> list[Result]:
    """[function(item) for item in items], side by side, in the order of the items. backend, workers: as of `finished`.

    An exception of an item ends the map: functions that may meet bad input return the reason instead.
    """
    tasks = [Task(str(k), item) for k, item in enumerate(items)]
    pairs = finished(functools.partial(_apply, function), tasks, Path(), desc, backend, workers)
    results = {task.name: result for task, result in pairs}
    return [results[task.name] for task in tasks]


def finished(
    function: Callable[[Task, Path], Result],
    tasks: Sequence[Task],
    root: Path,
    desc: str,
    backend: str = "loky",
    workers: int = -1,
    stage: str = "",
) -> Iterable[tuple[Task, Result]]:
    """(task, function(task, root)) of all tasks as they finish, in any order, with a progress bar on a terminal.

    backend: `loky` (processes here), `sequential`, or `dask` (a cluster, see stages.engine.cluster). There the function
    gets a folder that holds the files of the task and nothing else. workers: how many here, -1 for one a core. stage:
    where the workers of a cluster must have the same code of a stage.
    """
    work = functools.partial(_on_a_core, function)
    return progress(_finished(work, tasks, root, desc, backend, workers, stage), desc, len(tasks))


def progress(items: Iterable[Item], desc: str, total: int | None = None) -> Iterable[Item]:
    """The items, with a progress bar on a terminal; silent elsewhere."""
    return tqdm(items, desc=desc, total=total, disable=not sys.stderr.isatty())


def _finished(function, tasks, root, desc, backend, workers, stage) -> Iterator[tuple[Task, Any]]:
    if backend == "dask" and tasks:
        from .cluster import cluster_client, finished_on_cluster

        yield from finished_on_cluster(cluster_client(workers), function, tasks, root, desc, stage)
    elif backend == "sequential" or len(tasks) < 2:
        yield from ((task, function(task, root)) for task in tasks)
    else:
        # Caches make a worker grow; joblib then renews it between two items, loses none, and warns.
        warnings.filterwarnings("ignore", message="A worker stopped while some jobs")
        for tracker in (resource_tracker, loky_tracker):  # their start, inside the block, would let Ctrl-C through
            tracker.ensure_running()
        # Ctrl-C goes to all processes of a terminal: this one ends its workers, which would each print a traceback.
        with parallel_config(backend, n_jobs=workers), interrupts_wait():
            pairs: Any = Parallel(return_as="generator_unordered")(
                delayed(_named)(function, task, root) for task in tasks
            )
        yield from pairs


def _on_a_core(function, task, root):
    with core(), threadpool_limits(1):  # as workers of joblib have it: spinning threads would count as its cost
        return function(task, root)


def _named(function, task, root):
    process_executor._MAX_MEMORY_LEAK_SIZE = GROWTH  # of this worker, which looks at it after each item
    return task, function(task, root)


def _apply(function, task, root):
    return function(task.value)


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
