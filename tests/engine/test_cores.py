"""The budget of cores: never more at work than there are, and a killed process gives its core back."""

import multiprocessing
import os
import signal
import time
from pathlib import Path

import pytest

from stages.engine import parallel

CONTEXT = multiprocessing.get_context("fork")


def hold(inside: Path) -> None:
    with parallel.core():
        inside.write_text("in")
        time.sleep(60)


def wait_for(condition, seconds: float = 20.0) -> bool:
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    return condition()


@pytest.mark.slow
def test_no_more_processes_work_than_there_are_cores_and_a_killed_one_frees_its_core(tmp_path, monkeypatch):
    monkeypatch.setattr(parallel, "cpu_count", lambda: 2)
    with parallel.budget(tmp_path / "cores"):
        places = [tmp_path / str(number) for number in range(3)]
        processes = [CONTEXT.Process(target=hold, args=(place,)) for place in places]
        try:
            for process in processes:
                process.start()
            assert wait_for(lambda: sum(place.exists() for place in places) == 2)
            time.sleep(0.2)
            inside = [place.exists() for place in places]
            assert sum(inside) == 2
            os.kill(processes[inside.index(True)].pid or 0, signal.SIGKILL)
            assert wait_for(lambda: all(place.exists() for place in places))
        finally:
            for process in processes:
                process.kill()
                process.join()


def test_without_a_budget_nothing_waits(monkeypatch):
    monkeypatch.setattr(parallel, "cpu_count", lambda: 0)
    with parallel.core(), parallel.core():
        pass


def test_a_budget_ends_with_its_block(tmp_path):
    with parallel.budget(tmp_path):
        assert os.environ[parallel.FOLDER] == str(tmp_path)
    assert parallel.FOLDER not in os.environ


def interrupts_are_blocked(_item):
    return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, [])


def test_ctrl_c_reaches_this_process_and_none_of_its_workers():
    assert parallel.parallel_map(interrupts_are_blocked, range(4), "", "loky", 2) == [True] * 4
    assert not interrupts_are_blocked(0)
