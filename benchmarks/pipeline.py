"""Time and memory of the whole pipeline from a fresh copy: `python -m benchmarks.pipeline`

Copies the files that git knows or would add to build/bench, runs all stages of dvc.yaml there, as `make repro` does,
and writes reports/bench/pipeline.csv: a row a measurement (what, metric, value, unit, limit, machine).
`limit` is the figure that the project holds itself to. Results of the run stay in build/bench, to look at or to take
over; those of the working tree are left alone. Kernels are compiled before: that takes a minute, once a folder and
state of the code.
"""

import itertools
import os
import platform
import re
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import pandas as pd
import psutil

from benchmarks import arguments, reference_seconds
from haptic_glance.base.files import write_table

COPY = Path("build/bench")
OUT = Path("reports/bench/pipeline.csv")
STAGE = re.compile(r"Running stage '(\S+)':")  # what DVC says before it starts one
POLL = 1.0  # seconds between two looks at the memory of all processes: ten a second took a sixtieth of the time


def fresh_copy():
    """The files of the working tree, without what git ignores, and with nothing run yet."""
    shutil.rmtree(COPY, ignore_errors=True)
    listed = ["git", "ls-files", "-zco", "--exclude-standard"]
    files = subprocess.run(listed, capture_output=True, text=True, check=True).stdout
    for name in filter(None, files.split("\0")):
        if Path(name).exists():
            (COPY / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(name, COPY / name)
    subprocess.run(["git", "init", "-q"], cwd=COPY, check=True)
    (COPY / "dvc.lock").unlink(missing_ok=True)


def watch(command, cwd):
    """(seconds, peak bytes, {stage: processor seconds}) of a command: wall time, and memory of all its processes.

    That is the sum of proportional set sizes, where the system tells them (Linux), else of resident sizes.
    """
    start, peak = time.perf_counter(), 0
    environment = {**os.environ, "PYTHONPATH": "", "PYTHONUNBUFFERED": "1", "OPENBLAS_NUM_THREADS": "1"}
    process = psutil.Popen(command, cwd=cwd, env=environment, stdout=subprocess.PIPE, text=True)
    finished = threading.Event()

    def look():
        nonlocal peak
        while not finished.wait(POLL):
            try:
                family = [process, *process.children(recursive=True)]
                peak = max(peak, sum(memory(member) for member in family if member.is_running()))
            except psutil.Error:
                continue  # a worker ended between the list and the look

    looker = threading.Thread(target=look)
    looker.start()
    starts = []
    for line in process.stdout:
        if match := STAGE.match(line):
            starts.append((match[1], processor_seconds(process)))
    starts.append(("", processor_seconds(process)))
    process.wait()
    finished.set()
    looker.join()
    if process.returncode:
        sys.exit(f"bench: {' '.join(command)} failed with {process.returncode}")
    stages = {name: end - begin for (name, begin), (_, end) in itertools.pairwise(starts)}
    return time.perf_counter() - start, peak, stages


def processor_seconds(process):
    """Those of the children of a process that have ended; of a process that ended itself they are still known."""
    times = process.cpu_times()
    return times.children_user + times.children_system


def memory(process):
    """Bytes of a process, of shared pages its part."""
    usage = process.memory_full_info()
    return getattr(usage, "pss", usage.rss)


def main():
    """Runs the pipeline and writes the table."""
    arguments(__doc__)
    fresh_copy()
    compiling = "from stages.lod.cell import warm_up; warm_up()"
    subprocess.run([sys.executable, "-c", compiling], cwd=COPY, check=True, env={**os.environ, "PYTHONPATH": ""})
    loop = reference_seconds()
    rows = [{"what": "reference loop", "metric": "processor time", "value": loop, "unit": "s"}]
    total, peak, stages = watch(["dvc", "repro"], COPY)
    rows += [{"what": name, "metric": "processor time", "value": stages[name], "unit": "s"} for name in stages]
    again, _, _ = watch(["dvc", "repro"], COPY)
    size = sum(path.stat().st_size for path in (COPY / "data").rglob("*") if path.is_file())
    everything = sum(stages.values())
    rows += [
        {"what": "all stages", "metric": "wall time", "value": total, "unit": "s", "limit": 900},
        {"what": "all stages", "metric": "processor time", "value": everything, "unit": "s"},
        {"what": "all stages", "metric": "processor time in reference loops", "value": everything / loop},
        {"what": "all stages", "metric": "peak memory", "value": peak / 2**30, "unit": "GiB", "limit": 4},
        {"what": "dvc repro, unchanged", "metric": "wall time", "value": again, "unit": "s", "limit": 10},
        {"what": "data/", "metric": "size", "value": size / 2**30, "unit": "GiB", "limit": 2},
    ]
    frame = write(rows)
    smoke, _, _ = watch(["make", "smoke"], ".")  # last: it fails where the gate does
    frame = write([*rows, {"what": "make smoke", "metric": "wall time", "value": smoke, "unit": "s", "limit": 300}])
    print(frame.to_string(index=False))
    over = frame[frame.value > frame.limit]
    print("bench: all within their limits" if over.empty else f"bench: over the limit: {', '.join(over.what)}")


def write(rows):
    """Writes the table; returns it as a frame."""
    frame = pd.DataFrame(rows)
    frame["machine"] = f"{platform.machine()}, {len(os.sched_getaffinity(0))} cores, Python {platform.python_version()}"
    write_table(OUT, frame)
    return frame


if __name__ == "__main__":
    main()
