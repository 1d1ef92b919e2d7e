"""One function over many items, side by side, with a progress bar; the result never depends on the workers."""

import os
import sys

from joblib import Parallel, delayed, parallel_config
from tqdm import tqdm

from .params import load_params


def parallel_map(function, items, desc, backend=None, workers=None):
    """[function(item) for item in items] on the workers of `parallel` in params.yaml, in the order of the items.

    backend: `loky` (processes here), `dask` (a cluster: DASK_SCHEDULER names its scheduler, one is started here
    without it) or `sequential`. An exception of an item ends the map: functions that may meet bad input return the
    reason instead. The bar is silent when stderr is no terminal.
    """
    items = list(items)
    settings = load_params().get("parallel", {})
    backend = backend or settings.get("backend", "loky")
    workers = workers or settings.get("workers", -1)
    return list(progress(_results(function, items, backend, workers), desc, len(items)))


def progress(items, desc, total=None):
    """The items, with a progress bar on a terminal; silent elsewhere."""
    return tqdm(items, desc=desc, total=total, disable=not sys.stderr.isatty())


def _results(function, items, backend, workers):
    if backend == "sequential" or len(items) < 2:
        yield from map(function, items)
    elif backend == "dask":
        from distributed import Client  # an extra: `pip install haptic-glance[cluster]`

        with Client(os.environ.get("DASK_SCHEDULER")), parallel_config("dask"):
            yield from Parallel()(delayed(function)(item) for item in items)
    else:
        with parallel_config(backend, n_jobs=workers):
            yield from Parallel(return_as="generator")(delayed(function)(item) for item in items)
