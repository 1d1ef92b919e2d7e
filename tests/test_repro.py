"""Stages side by side: what may start, what is left out, and the same dvc.lock as DVC itself writes."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from stages.repro import BLAS, Schedule, causes_of, patient

NEEDS = {"a": set(), "b": {"a"}, "c": {"a"}, "d": {"b", "c"}}
GRAPH = """stages:
  a: {cmd: "cat source > a; echo BLAS has $OPENBLAS_NUM_THREADS thread", deps: [source], outs: [a]}
  b: {cmd: "touch b_began; until [ -e c_began ]; do sleep 0.05; done; cat a > b", deps: [a], outs: [b]}
  c: {cmd: "touch c_began; until [ -e b_began ]; do sleep 0.05; done; cat a > c", deps: [a], outs: [c]}
  d: {cmd: "cat b c > d", deps: [b, c], outs: [d]}
"""


def test_a_stage_waits_for_all_that_it_needs():
    schedule = Schedule(NEEDS, {"a"})
    assert [schedule.take(), schedule.take()] == ["a", None]
    schedule.end("a", executed=True)
    assert [schedule.take(), schedule.take(), schedule.take()] == ["b", "c", None]
    schedule.end("b", executed=True)
    assert schedule.take() is None
    schedule.end("c", executed=True)
    assert schedule.take() == "d"


def test_a_stage_that_did_not_change_starts_nothing():
    schedule = Schedule(NEEDS, set())
    assert schedule.take() is None and schedule.ended == set(NEEDS)
    schedule = Schedule(NEEDS, {"a"})
    assert schedule.take() == "a"
    schedule.end("a", executed=False)
    assert schedule.take() is None and schedule.ended == set(NEEDS)


def test_a_failure_leaves_out_what_needs_it_and_nothing_else():
    schedule = Schedule(NEEDS | {"e": {"c"}}, {"b", "c"})
    assert schedule.take() == "b"
    assert schedule.fail("b") == ["d"] and schedule.waiting == ["c", "e"]
    assert schedule.take() == "c"


def test_a_stage_that_meets_a_lock_tries_again_and_other_errors_tell_their_cause():
    from dvc.lock import LockError

    calls = []

    def call(error):
        calls.append(error)
        if len(calls) < 3:
            raise ValueError("failed to reproduce") from error
        return "done"

    assert patient(lambda: call(LockError("busy"))) == "done" and len(calls) == 3
    with pytest.raises(ValueError, match="another run of DVC is at work here: run it again when that has ended"):
        patient(lambda: [calls.clear(), call(LockError("busy: you can manually remove the lock"))])
    calls.clear()
    with pytest.raises(ValueError, match="failed to reproduce") as failure:
        patient(lambda: call(KeyError("no such file")))
    assert len(calls) == 1 and [str(cause) for cause in causes_of(failure.value)][1:] == ["'no such file'"]


def repro(folder: Path) -> subprocess.CompletedProcess[str]:
    line = [sys.executable, "-m", "stages.repro"]
    environment = {name: value for name, value in os.environ.items() if name != BLAS}  # Dask sets it in this process
    return subprocess.run(  # b and c wait for each other
        line, cwd=folder, env=environment, capture_output=True, text=True, timeout=300
    )


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)
    (tmp_path / ".dvc").mkdir()
    (tmp_path / ".dvc/config").write_text("[core]\n    analytics = false\n")
    (tmp_path / "dvc.yaml").write_text(GRAPH)
    (tmp_path / "source").write_text("one")
    return tmp_path


@pytest.mark.slow
def test_a_failing_stage_is_named_and_the_others_go_on_side_by_side_until_dvc_sees_nothing_left_to_do(repository: Path):
    (repository / "dvc.yaml").write_text(GRAPH.replace("cat a > b", "echo no such sensor >&2; exit 3"))
    process = repro(repository)
    assert process.returncode == 1 and (repository / "c").exists() and not (repository / "d").exists()
    assert "BLAS has 1 thread" in process.stdout  # more would spin beside those of the other stage
    assert "b failed:\nno such sensor" in process.stderr and "left out: d" in process.stderr
    (repository / "dvc.yaml").write_text(GRAPH)
    process = repro(repository)
    assert process.returncode == 0 and (repository / "d").read_text() == "oneone", process.stderr
    assert process.stderr.endswith("repro: all stages are up to date\n")
    status = subprocess.run([sys.executable, "-m", "dvc", "status"], cwd=repository, capture_output=True, text=True)
    assert "up to date" in status.stdout
