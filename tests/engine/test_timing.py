"""Seconds of rows: of the processor, whatever else runs."""

import subprocess
import sys
import time

import pytest

from haptic_glance.base.timing import CLOCK, Stopwatch, WallClock, clock
from stages.engine.parallel import parallel_map
from stages.engine.rows import read_rows, write_rows


def work(rounds: int = 600_000) -> float:
    """Seconds of a fixed amount of computing."""
    with Stopwatch() as watch:
        sum(number * number for number in range(rounds))
    return watch.seconds


def test_sleep_costs_nothing():
    with WallClock() as wall, Stopwatch() as watch:
        time.sleep(0.2)
    assert wall.seconds >= 0.2 and watch.seconds < 0.1  # other threads of the process may compute


def test_computing_costs_its_time():
    before = time.process_time()
    with Stopwatch() as watch:
        while time.process_time() < before + 0.1:
            pass
    assert watch.seconds == pytest.approx(0.1, abs=0.03)


def test_busy_processes_beside_it_cost_nothing():
    """Wall time of the same block grows where more processes run than there are cores."""
    alone = min(work() for _ in range(5))
    others = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(4)]
    try:
        beside = min(work() for _ in range(5))
    finally:
        for other in others:
            other.kill()
            other.wait()
    assert beside < 2 * alone


def test_rows_name_the_clock(tmp_path):
    path = tmp_path / "stage.csv.gz"
    write_rows(path, [{"metric": "faces", "value": 1, "seconds": 0.5}, {"metric": "faces", "value": 2}], {}, "set", 0)
    assert read_rows(path)["clock"].fillna("").tolist() == [clock(), ""]
    assert clock().startswith(CLOCK)


def threads(_: int) -> list[int]:
    from threadpoolctl import threadpool_info

    return [library["num_threads"] for library in threadpool_info()]


@pytest.mark.parametrize("backend", ["loky", "sequential"])
def test_libraries_have_one_thread_for_an_item(backend):
    found = parallel_map(threads, range(2), "", backend=backend, workers=2)
    assert all(counts and set(counts) == {1} for counts in found)
