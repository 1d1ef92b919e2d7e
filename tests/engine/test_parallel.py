"""Parallel work: one thread an item, seconds of the processor, and workers that end with their parent."""

import functools
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from joblib.externals.loky import process_executor

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import CLOCK, Stopwatch, WallClock, clock
from stages.engine import parallel
from stages.engine.parallel import GROWTH, parallel_map
from stages.engine.rows import read_rows, write_rows

ROOT = Path(__file__).parents[2]


def noisy(name):
    return rng(3, name).normal()


@pytest.mark.slow
def test_result_does_not_depend_on_workers_or_order():
    names = [f"item {i}" for i in range(8)]
    ordered = parallel_map(noisy, names, "one", "sequential", 1)
    turned = parallel_map(noisy, names[::-1], "turned", "loky", 2)
    assert ordered == turned[::-1] and len(set(ordered)) == 8


def state_of_worker(_item):
    """(whether Ctrl-C is blocked, the growth of memory that joblib's loop allows, numbers of threads of libraries)."""
    from threadpoolctl import threadpool_info

    blocked = signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [])
    threads = {library["num_threads"] for library in threadpool_info()}
    return blocked, process_executor._MAX_MEMORY_LEAK_SIZE, threads


@pytest.mark.slow
def test_workers_have_one_thread_leave_ctrl_c_to_this_process_and_may_grow_as_far_as_we_say():
    assert parallel_map(state_of_worker, range(4), "", "loky", 2) == [(True, GROWTH, {1})] * 4
    assert "_MAX_MEMORY_LEAK_SIZE" in process_executor._process_worker.__code__.co_names
    blocked, _, threads = parallel_map(state_of_worker, [0], "", "sequential", 1)[0]
    assert not blocked and threads == {1}


def test_seconds_are_those_of_the_processor():
    with WallClock() as wall, Stopwatch() as watch:
        time.sleep(0.2)
    assert wall.seconds >= 0.2 and watch.seconds < 0.1  # other threads of the process may compute
    before = time.process_time()
    with Stopwatch() as watch:
        while time.process_time() < before + 0.1:
            pass
    assert watch.seconds == pytest.approx(0.1, abs=0.03)


def test_rows_name_the_clock(tmp_path):
    path = tmp_path / "stage.csv.gz"
    write_rows(path, [{"metric": "faces", "value": 1, "seconds": 0.5}, {"metric": "faces", "value": 2}], {}, "set", 0)
    assert read_rows(path)["clock"].fillna("").tolist() == [clock(), ""]
    assert clock().startswith(CLOCK)


PATIENCE = 60  # seconds, on a machine that does much else
BUSY = """
import os, sys, time
from pathlib import Path
from haptic_glance.base.errors import errors_in_one_line
from stages.engine.parallel import finished

def work(name):
    Path(sys.argv[1], str(os.getpid())).touch()
    time.sleep(600)

if __name__ == "__main__":
    errors_in_one_line("busy")
    list(finished(work, [1, 2, 3], "busy", "loky", 2))
"""


def wait_for(condition):
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
def test_a_signal_that_ends_a_stage_ends_its_busy_workers(number, tmp_path):
    (tmp_path / "busy.py").write_text(BUSY)
    (tmp_path / "workers").mkdir()
    environment = os.environ | {"PYTHONPATH": f"{ROOT}{os.pathsep}{tmp_path}"}
    command = [sys.executable, "-m", "busy", str(tmp_path / "workers")]
    # A job in the background of a shell ignores Ctrl-C, and so would its child.
    heard = functools.partial(signal.signal, number, signal.SIG_DFL) if number != signal.SIGKILL else None
    with subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True, preexec_fn=heard) as process:
        try:
            wait_for(lambda: len(list((tmp_path / "workers").iterdir())) == 2)
            process.send_signal(number)
            process.wait(PATIENCE)
            workers = [int(path.name) for path in (tmp_path / "workers").iterdir()]
            wait_for(lambda: not any(map(psutil.pid_exists, workers)))
        finally:
            process.kill()
    assert process.returncode == -number


def test_one_worker_is_this_process():
    assert parallel_map(abs, [-1, 2], "", "loky", 1) == [1, 2]


@pytest.mark.slow
def test_a_cluster_gives_the_same_results_and_a_process_starts_one_for_all_its_maps(capsys):
    pytest.importorskip("distributed", reason="the cluster extra is not installed")
    names = ["a", "b", "c"]
    try:
        for _ in range(2):
            assert parallel_map(noisy, names, "", "dask", 1) == parallel_map(noisy, names, "", "sequential")
        assert capsys.readouterr().err.count("dask: dashboard http") == 1
    finally:
        client = parallel._client(1)
        client.close()
        client.cluster.close()
        parallel._client.cache_clear()
