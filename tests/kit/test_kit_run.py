"""Randomness by name, results independent of the workers, and runs that can be killed."""

import functools
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from stages.kit import StageRun, parallel_map
from stages.kit.files import read_table, write_text
from stages.kit.rng import rng
from stages.kit.stats import bootstrap_interval


def noisy(name):
    return rng(3, name).normal()


def test_result_does_not_depend_on_workers_or_order():
    names = [f"item {i}" for i in range(8)]
    one = parallel_map(noisy, names, "one", "sequential", 1)
    two = parallel_map(noisy, names, "two", "loky", 2)
    turned = parallel_map(noisy, names[::-1], "turned", "loky", 2)
    assert one == two == turned[::-1] and len(set(one)) == 8


def test_dask_gives_the_same_result():
    pytest.importorskip("distributed", reason="the cluster extra is not installed")
    assert parallel_map(noisy, ["a", "b", "c"], "dask", "dask", 2) == [noisy(name) for name in "abc"]


def test_bootstrap_interval_covers_the_mean_and_narrows():
    values = np.random.default_rng(0).normal(5, 1, 400)
    mean, low, high = bootstrap_interval(values)
    wide = bootstrap_interval(values[:25])
    assert low < mean < high and low < 5 < high and high - low < wide[2] - wide[1]
    assert high - low == pytest.approx(2 * 1.96 / 20, rel=0.15)  # the normal theory's width


def test_bootstrap_interval_of_one_value_is_unknown():
    mean, low, high = bootstrap_interval([0.5, np.nan])
    assert mean == 0.5 and np.isnan(low) and np.isnan(high)


def write_item(name, folder, log):
    with open(log, "a") as stream:
        stream.write(f"{name}\n")
    write_text(folder / f"{name}.txt", name)
    return [{"object": name, "metric": "length", "value": len(name), "seconds": 0.1}]


@pytest.fixture
def workspace(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("params.yaml").write_text("seed: 0\nparallel: {backend: sequential}\ndemo: {x: 1}\n")
    return tmp_path


def test_failed_run_keeps_the_old_folder_and_goes_on_where_it_stopped(workspace):
    process = functools.partial(write_item, log=workspace / "log")
    with StageRun("demo") as run:
        run.each(process, ["a"])
    Path("params.yaml").write_text("seed: 0\nparallel: {backend: sequential}\ndemo: {x: 2}\n")
    with pytest.raises(RuntimeError), StageRun("demo") as run:
        run.each(process, ["b"])
        raise RuntimeError
    assert [path.name for path in Path("data/demo").iterdir()] == ["a.txt"]
    with StageRun("demo") as run:
        run.each(process, ["b", "c"])
    assert sorted(path.name for path in Path("data/demo").iterdir()) == ["b.txt", "c.txt"]
    assert (workspace / "log").read_text().split() == ["a", "b", "c"]  # b was not made again
    assert read_table("reports/measurements/demo.csv").object.tolist() == ["b", "c"]
    assert not list(Path("data/.partial").iterdir())


def test_a_run_without_rows_leaves_a_table_of_headings(workspace):
    with StageRun("demo") as run:
        run.metrics({})
    table = read_table(Path("reports/measurements/demo.csv"))
    assert table.empty and {"object", "metric", "value"} <= set(table)


def test_changed_settings_or_input_start_afresh(workspace):
    Path("data/up").mkdir(parents=True)
    Path("data/up/x").write_text("1")
    first = StageRun("demo", inputs=("up",)).folder
    Path("data/up/x").write_text("2")
    second = StageRun("demo", inputs=("up",)).folder
    Path("params.yaml").write_text("seed: 1\ndemo: {x: 1}\n")
    assert len({first, second, StageRun("demo", inputs=("up",)).folder}) == 3


def refuse(name, folder):
    raise ValueError("too small")


def test_an_error_names_the_object(workspace):
    with pytest.raises(ValueError, match="b c: too small"), StageRun("demo") as run:
        run.each(refuse, ["b c"])


def test_missing_input_names_the_stage_to_run(workspace):
    with pytest.raises(ValueError, match="data/up is not there: run `dvc repro up` first"), StageRun("demo", ("up",)):
        pass
    assert not Path("data/.partial").exists()


@pytest.mark.parametrize(
    ("raised", "lines", "code"),
    [
        ("KeyboardInterrupt", ["demo: stopped"], -signal.SIGINT),
        ("ValueError('too small')", ["demo: too small"], 1),
    ],
)
def test_what_a_person_did_ends_in_one_line(raised, lines, code):
    program = f"from stages.kit.run import errors_in_one_line\nerrors_in_one_line('demo')\nraise {raised}"
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    done = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True)
    assert (done.stderr.splitlines(), done.returncode) == (lines, code)


KILLED = """
import os, signal, sys
from stages.kit import StageRun
from stages.kit.files import write_text
def item(name, folder):
    write_text(folder / name, name)
    (folder / ".part-half").write_text("x") if sys.argv[1] == "die" else None
    if name == "b" and sys.argv[1] == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    return [{"object": name, "metric": "m", "value": 1, "seconds": 0}]
with StageRun("demo") as run:
    run.each(item, ["a", "b", "c"])
"""


def test_killed_run_leaves_nothing_in_place_and_the_next_gives_the_same_bytes(workspace):
    root = str(Path(__file__).parents[2])
    environment = {**os.environ, "PYTHONPATH": root}
    command = [sys.executable, "-c", KILLED]
    assert subprocess.run([*command, "die"], env=environment).returncode == -signal.SIGKILL
    assert not Path("data/demo").exists()
    assert subprocess.run([*command, "live"], env=environment).returncode == 0
    assert {path.name: path.read_text() for path in Path("data/demo").iterdir()} == {x: f"{x}\n" for x in "abc"}
