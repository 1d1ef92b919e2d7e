"""The cost of a cluster for an item, and the number of workers that no longer helps: `python -m benchmarks.cluster`

Takes a few objects of the finished run of a data set, in data/, and makes them again stage by stage, one after the
other: the bytes that an item alone reads and gives back, and its seconds of one core (the first item's include the
compilation of kernels). Files that several items read travel once, and are not counted. Then sends empty tasks, and
tasks of a megabyte each way, through a scheduler and workers on this machine: the seconds of one core that client and
scheduler spend on each. Writes reports/bench/cluster.csv: a row a stage and one for all of them, with `limit`, the
number of workers that keep either the scheduler or its network of 1 Gbit/s busy, and the hours for 820 models (the
furniture of Sweet Home 3D) on 1, 10, 100 and 1000 workers. Argument: the data set, household without one.
"""

import functools
import importlib
import os
import platform
import shutil
import time
from collections import Counter
from pathlib import Path

import pandas as pd

from benchmarks import arguments
from haptic_glance.base.files import write_table
from stages.engine import cluster, run
from stages.engine.parallel import Task, finished
from stages.engine.settings import Workspace

OUT, COPY = Path("reports/bench/cluster.csv"), Path("build/cluster")
STAGES = ("views", "conspicuity", "salient_points", "lod", "imprints")  # those that a new mesh goes through
OBJECTS, TASKS, MODELS, WORKERS = 3, 300, 820, (1, 10, 100, 1000)
NETWORK = 1e9 / 8  # bytes per second, each way, at the machine of the scheduler: all that travels passes it
MEGABYTE = 2**20


def copied(dataset):
    """The Workspace of a few objects in a copy of what the stages read."""
    shutil.rmtree(COPY, ignore_errors=True)
    data = Path("data", dataset)
    names = sorted(path.stem for path in (data / "meshes").glob("*.npz"))
    COPY.mkdir(parents=True)
    shutil.copytree(data / "weights", COPY / data / "weights")
    for name in names[:: -(-len(names) // OBJECTS)]:
        (COPY / data / "meshes").mkdir(exist_ok=True)
        shutil.copy2(data / f"meshes/{name}.npz", COPY / data / "meshes")
    text = Path("params.yaml").read_text().replace("backend: loky", "backend: sequential")
    (COPY / "params.yaml").write_text(text)
    return Workspace(COPY, dataset)


def timed(function, task, root):
    """(what the function gives, its seconds of one core)."""
    start = time.process_time()
    return function(task, root), time.process_time() - start


def items_of(workspace, stage):
    """[{input, result (bytes), seconds}] of the items of a stage, which is run."""
    items = []

    def watched(function, tasks, root, *rest, **options):
        uses = Counter(digest for task in tasks for digest in set(task.files.values()))
        for task, (content, seconds) in finished(functools.partial(timed, function), tasks, root, *rest, **options):
            size = sum((root / path).stat().st_size for path, d in task.files.items() if d and uses[d] == 1)
            items.append({"input": size, "result": len(content), "seconds": seconds})
            yield task, content

    run.finished = watched
    importlib.import_module(f"stages.{stage}.__main__").run(workspace)
    return items


def seconds_a_task(root, size):
    """Seconds that client and scheduler spend on a task with inputs and results of `size` bytes, all of them apart."""
    tasks = []
    for k in range(TASKS):
        path = root / f"{k}.bin"
        path.write_bytes(k.to_bytes(4, "little") * (size // 4))
        tasks.append(Task(str(k), None, {path.name: str(k)} if size else {}))
    send = functools.partial(echo, size=size)
    list(finished(send, tasks[:8], root, "warm up", "dask"))
    start = time.process_time()  # of client and scheduler, which are in this process, but not of the workers
    list(finished(send, tasks, root, "overhead", "dask"))
    return (time.process_time() - start) / len(tasks)


def echo(task, root, size):
    """Returns the bytes that the task has brought."""
    return bytes(size)


def line(stage, items, empty, byte):
    """The row of a stage whose items are known. empty: seconds of a task without data; byte: of each byte more."""
    table = pd.DataFrame(items).mean()
    scheduler = empty + byte * (table["input"] + table["result"])
    network = max(table["input"], table["result"]) / NETWORK
    least = MODELS * max(scheduler, network)
    hours = {f"hours_{n}": max(-(-MODELS // n) * table["seconds"], least) / 3600 for n in WORKERS}
    return {
        "stage": stage, "items": len(items), "input_kib": table["input"] / 1024, "result_kib": table["result"] / 1024,
        "seconds": table["seconds"], "scheduler_ms": 1000 * scheduler, "network_ms": 1000 * network,
        "limit": table["seconds"] / max(scheduler, network), **hours,
    }  # fmt: skip


def main():
    """Measures the stages and the scheduler, and writes the table."""
    dataset = arguments(__doc__, dataset="household").dataset
    workspace = copied(dataset)
    items = {stage: items_of(workspace, stage) for stage in STAGES}
    empty = seconds_a_task(COPY, 0)
    byte = (seconds_a_task(COPY, MEGABYTE) - empty) / (2 * MEGABYTE)
    frame = pd.DataFrame([line(stage, entries, empty, byte) for stage, entries in items.items()])
    whole = frame.drop(columns=["stage", "items", "limit"]).sum()
    whole["limit"] = whole["seconds"] / (frame[["scheduler_ms", "network_ms"]].max(axis=1).sum() / 1000)
    frame = pd.concat([frame, pd.DataFrame([{"stage": "all", "items": OBJECTS, **whole}])], ignore_index=True)
    frame["empty_task_ms"], frame["ms_per_mib"] = 1000 * empty, 1000 * MEGABYTE * byte
    frame["machine"] = f"{platform.machine()}, {len(os.sched_getaffinity(0))} cores, Python {platform.python_version()}"
    write_table(OUT, frame)
    print(frame.drop(columns="machine").round(3).to_string(index=False))
    client = cluster.cluster_client(-1)
    client.close()


if __name__ == "__main__":
    main()
