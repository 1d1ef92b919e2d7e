"""Items on a cluster of machines that share no folder: their inputs and results travel, by dask.

The files that one item reads travel with it. Files that several items read go to the cluster once, by its content, and
from worker to worker from there. The scheduler holds both until they are no longer needed, so that it can give them to
another worker when one is lost: data that is scattered on workers would be lost with them.
"""

import functools
import os
import pickle
import queue
import socket
import sys
import tempfile
import uuid
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from joblib import cpu_count

from haptic_glance.base.extras import from_extra

from .code import stage_digest
from .parallel import Task

with from_extra():
    import cloudpickle
    import dask.config
    from distributed import CancelledError, Client, Future, KilledWorker, LocalCluster, get_worker

SCHEDULER = "DASK_SCHEDULER"  # the environment variable that holds the scheduler's address
AHEAD = 2  # items a worker has at a time: one that runs, and one whose inputs are there when it ends
NEWS = 2.0  # seconds after which workers that have joined get items, even if none has finished
THREADS = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")


@functools.cache
def cluster_client(workers: int) -> Client:
    """The one client of this process, of the scheduler that DASK_SCHEDULER names; its dashboard is named on stderr.

    Without that, `workers` processes are started here, -1 for one a core. They share its cores, as those of loky do.
    """
    dask.config.set({"distributed.admin.large-graph-warning-threshold": "1 TiB"})  # inputs are meant to travel
    client = Client(os.environ.get(SCHEDULER) or _workers_here(cpu_count() if workers < 1 else workers))
    print(f"dask: dashboard {client.dashboard_link}", file=sys.stderr)
    return client


def _workers_here(count):
    threads = {f"distributed.nanny.pre-spawn-environ.{name}": max(cpu_count() // count, 1) for name in THREADS}
    with dask.config.set(threads):
        return LocalCluster(count, threads_per_worker=1, memory_limit=0, dashboard_address="127.0.0.1:0")


def finished_on_cluster(
    client: Client,
    function: Callable[[Task, Path], Any],
    tasks: Sequence[Task],
    root: Path,
    desc: str,
    stage: str = "",
) -> Iterator[tuple[Task, Any]]:
    """(task, function(task, folder)) of all tasks as they finish; the folder holds the task's files from below `root`.

    Few items are on the cluster at a time, so neither inputs nor results pile up. When a worker is lost, its items go
    to another one. Raises OSError that names the item when that happens too often (dask's `allowed-failures`), and
    ValueError where `stage` is given and a worker has other code of it.
    """
    sender = _Sender(client, function, tasks, root, f"{desc} {uuid.uuid4().hex[:8]}", stage)
    waiting, running, arrivals = list(reversed(tasks)), {}, queue.SimpleQueue()
    try:
        while waiting or running:
            threads: Any = client.nthreads()
            room = AHEAD * max(sum(threads.values()), 1) - len(running)  # clusters that adapt start by what waits
            for _ in range(min(room, len(waiting))):
                task = waiting.pop()
                future = sender.send(task)
                running[future.key] = task, future
                future.add_done_callback(arrivals.put)
            try:
                future = arrivals.get(timeout=NEWS)
            except queue.Empty:
                continue
            result = _result(future, running)
            task, _ = running.pop(future.key)
            future.release()
            yield task, result
    finally:
        client.cancel([*(future for _, future in running.values()), *sender.sent.values()])


class _Sender:
    """Submits tasks with their inputs; what more than one of them reads, it submits once."""

    def __init__(self, client, function, tasks, root, desc, stage):
        self.client, self.root, self.desc = client, root, desc
        self.code = (stage, stage_digest(stage) if stage else "")
        uses = Counter(digest for task in tasks for digest in set(task.files.values()))
        self.common = {digest for digest, count in uses.items() if count > 1}
        function_bytes = cloudpickle.dumps(function)
        self.function = client.submit(_content, function_bytes, key=f"{desc}-function")
        self.sent: dict[str, Future] = {"": self.function}

    def send(self, task: Task) -> Future:
        """The future of one task."""
        files = {path: digest for path, digest in task.files.items() if digest}
        common = {path: self._common(path, digest) for path, digest in files.items() if digest in self.common}
        contents = {path: (self.root / path).read_bytes() for path in files if path not in common}
        arguments = self.code, self.function, cloudpickle.dumps(task), contents, list(common), *common.values()
        return self.client.submit(_work, *arguments, key=f"{self.desc}-{task.name}")

    def _common(self, path, digest):
        if digest not in self.sent:
            self.sent[digest] = self.client.submit(_content, (self.root / path).read_bytes(), key=f"file-{digest}")
        return self.sent[digest]


def _result(future: Future, running: Mapping[Any, tuple[Task, Future]]) -> Any:
    name = running[future.key][0].name
    try:
        return future.result()
    except KilledWorker as error:
        # Items that waited on the same workers are lost as often: all of them are named.
        lost_tasks = [task.name for task, job in running.values() if job.status == "error"]
        often = f"{', '.join(lost_tasks)}: lost {error.allowed_failures + 1} workers"
        raise OSError(f"{often}: is their memory too small? The logs of the workers may tell more") from None
    except CancelledError:
        raise OSError(f"{name}: the scheduler is gone; run the stage again, what is finished is kept") from None


def _content(content: bytes) -> bytes:
    return content


def _work(
    code: tuple[str, str],
    function: bytes,
    task: bytes,
    contents: Mapping[str, bytes],
    paths: Sequence[str],
    *common: bytes,
) -> Any:
    """Runs on a worker: function(task, folder), with the task's files below the folder, which is removed afterwards."""
    _check_code(*code)
    with tempfile.TemporaryDirectory(dir=get_worker().local_directory) as folder:
        for path, content in [*contents.items(), *zip(paths, common, strict=True)]:
            file = Path(folder, path)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)
        return pickle.loads(function)(pickle.loads(task), Path(folder))


def _check_code(stage, digest):
    if stage and (actual := stage_digest(stage)) != digest:
        raise ValueError(
            f"the worker on {socket.gethostname()} has other code of the stage {stage} ({actual}) than this machine "
            f"({digest}): install the same version there, and start the worker anew"
        )
