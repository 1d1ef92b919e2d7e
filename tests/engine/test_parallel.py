"""Work side by side: a budget of cores, one thread an item, seconds of the processor, and results alike."""

import multiprocessing
import os
import signal
import time
from pathlib import Path

import pytest
from joblib.externals.loky import process_executor

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import CLOCK, Stopwatch, WallClock, clock
from stages.engine import parallel
from stages.engine.parallel import GROWTH, parallel_map
from stages.engine.rows import read_rows, write_rows

PATIENCE = 300  # seconds, on a machine that does much else


def hold(inside: Path) -> None:
    with parallel.core():
        inside.write_text("in")
        time.sleep(2 * PATIENCE)


def wait_for(condition) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


@pytest.mark.slow
def test_no_more_processes_work_than_there_are_cores_and_a_killed_one_frees_its_core(tmp_path, monkeypatch):
    monkeypatch.setattr(parallel, "cpu_count", lambda: 2)
    with parallel.budget(tmp_path / "cores"):
        places = [tmp_path / str(number) for number in range(3)]
        context = multiprocessing.get_context("fork")
        processes = [context.Process(target=hold, args=(place,)) for place in places]
        try:
            for process in processes:
                process.start()
            wait_for(lambda: sum(place.exists() for place in places) >= 2)
            time.sleep(0.2)
            inside = [place.exists() for place in places]
            assert sum(inside) == 2
            os.kill(processes[inside.index(True)].pid or 0, signal.SIGKILL)
            wait_for(lambda: all(place.exists() for place in places))
        finally:
            for process in processes:
                process.kill()
                process.join()


def test_a_budget_ends_with_its_block_and_without_one_nothing_waits(tmp_path, monkeypatch):
    with parallel.budget(tmp_path):
        assert os.environ[parallel.FOLDER] == str(tmp_path)
    assert parallel.FOLDER not in os.environ
    monkeypatch.setattr(parallel, "cpu_count", lambda: 0)
    with parallel.core(), parallel.core():
        pass


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
