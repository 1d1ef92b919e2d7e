"""One function over many items, side by side, with a progress bar; the result never depends on the workers."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar

from joblib import Parallel, delayed, parallel_config
from tqdm import tqdm

from .cores import core

Item = TypeVar("Item")
Result = TypeVar("Result")


def parallel_map(
    function: Callable[[Item], Result],
    items: Iterable[Item],
    desc: str,
    backend: str = "loky",
    workers: int = -1,
) -> list[Result]:
    """[function(item) for item in items], side by side, in the order of the items.

    backend: `loky` (processes here), `dask` (a cluster: DASK_SCHEDULER names its scheduler; without it one is started
    here) or `sequential`. An exception of an item ends the map: functions that may meet bad input return the reason
    instead. The bar is silent when stderr is not a terminal.
    """
    items = list(items)
    return list(progress(_results(function, items, backend, workers), desc, len(items)))


def progress(items: Iterable[Item], desc: str, total: int | None = None) -> Iterable[Item]:
    """The items, with a progress bar on a terminal; silent elsewhere."""
    return tqdm(items, desc=desc, total=total, disable=not sys.stderr.isatty())


def _results(function: Callable[[Item], Result], items: list[Item], backend: str, workers: int) -> Iterator[Any]:
    if backend == "sequential" or len(items) < 2:
        yield from (_on_a_core(function, item) for item in items)
    elif backend == "dask":
        from distributed import Client  # an extra: `pip install haptic-glance[cluster]`

        with Client(os.environ.get("DASK_SCHEDULER")), parallel_config("dask"):
            yield from Parallel()(delayed(function)(item) for item in items)
    else:
        with parallel_config(backend, n_jobs=workers):
            yield from Parallel(return_as="generator")(delayed(_on_a_core)(function, item) for item in items)


def _on_a_core(function: Callable[[Item], Result], item: Item) -> Result:
    with core():
        return function(item)
