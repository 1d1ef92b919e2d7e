"""Runs of a stage: objects that are made once, inputs that must be declared, and runs that fail or are killed."""

import functools
import multiprocessing
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from haptic_glance.base.files import write_text
from stages.engine.rows import read_rows
from stages.engine.run import StageRun, UndeclaredRead
from stages.engine.settings import Workspace

ROOT = Path(__file__).parents[2]


PARAMS = "seed: 0\nprofile: test\nparallel: {backend: sequential}\nsets: [toys]\ngraph: {views: [toys]}\ntoys: {}\n"


@pytest.fixture
def workspace(tmp_path):
    write_text(tmp_path / "params.yaml", PARAMS)
    for name in "abc":
        write_text(tmp_path / f"data/toys/meshes/{name}.txt", name)
    return Workspace(tmp_path, "toys")


def write_item(name, folder, log, data, factor=1):
    """Copies the object's input; the log tells for whom it ran."""
    with open(log, "a") as stream:
        stream.write(f"{name}\n")
    text = (data / f"meshes/{name}.txt").read_text()
    write_text(folder / f"deep/{name}.txt", text * factor)
    return [{"item": name, "metric": "length", "value": len(text), "seconds": 0.1}]


def run_items(workspace, names="abc", factor=1, reads=("meshes/{}.txt",), broken=False):
    """Runs the stage `views` on some objects; returns the names of those that were made anew."""
    log = workspace.root / "log"
    write_text(log, "")
    work = functools.partial(write_item, log=log, data=workspace.data, factor=factor)
    with StageRun(workspace, "views", inputs=("meshes",)) as run:
        run.each(work, names, reads=reads)
        if broken:
            raise RuntimeError
    return log.read_text().split()


def made(workspace):
    return {path.stem: path.read_text().strip() for path in (workspace.data / "views/deep").glob("*")}


def test_an_object_is_made_once(workspace):
    assert run_items(workspace) == ["a", "b", "c"]
    before = (made(workspace), (workspace.measurements / "views.csv.gz").read_bytes())
    assert run_items(workspace) == []
    assert (made(workspace), (workspace.measurements / "views.csv.gz").read_bytes()) == before


def meanwhile(name, folder, root):
    """Writes a file; the first call then runs the same stage of the other set, with the same object, to its end."""
    write_text(folder / f"{name}.txt", name)
    if not (root / "begun").exists():
        write_text(root / "begun", "")
        other = multiprocessing.get_context("spawn").Process(target=run_shared, args=[Workspace(root, "others")])
        other.start()
        other.join()
    return [{"item": name, "metric": "length", "value": 1, "seconds": 0.1}]


def run_shared(workspace):
    with StageRun(workspace, "views", inputs=("meshes",)) as run:
        run.each(functools.partial(meanwhile, root=workspace.root), ["a"])


@pytest.mark.slow
def test_two_sets_with_an_object_in_common_may_run_at_the_same_time(workspace):
    path = workspace.root / "params.yaml"
    write_text(path, path.read_text().replace("[toys]", "[toys, others]") + "others: {}\n")
    write_text(workspace.root / "data/others/meshes/a.txt", "a")
    run_shared(workspace)
    assert [(workspace.root / f"data/{name}/views/a.txt").read_text() for name in ("toys", "others")] == ["a\n"] * 2


def test_a_changed_or_new_object_or_setting_is_made_again_and_a_removed_object_is_gone(workspace):
    run_items(workspace)
    write_text(workspace.data / "meshes/b.txt", "other")
    write_text(workspace.data / "meshes/d.txt", "d")
    assert run_items(workspace, "abcd") == ["b", "d"] and made(workspace)["b"] == "other"
    assert run_items(workspace, "ab", factor=2) == ["a", "b"] and set(made(workspace)) == set("ab")


def test_changed_code_is_made_again(workspace, monkeypatch):
    run_items(workspace)
    monkeypatch.setattr("stages.engine.run.stage_digest", lambda stage: "other")
    monkeypatch.setattr("stages.engine.run._is_of_stages", lambda function: True)
    assert run_items(workspace) == ["a", "b", "c"]


def test_reading_what_was_not_declared_is_an_error(workspace):
    with pytest.raises(UndeclaredRead, match="meshes/a.txt is read, but not declared"):
        run_items(workspace, reads=("views/{}.npz",))


def count_letters(name, folder, made, log):
    """Counts what an earlier call has written for an object."""
    with open(log, "a") as stream:
        stream.write(f"count-{name}\n")
    return [{"item": name, "metric": "letters", "value": len((made / f"deep/{name}.txt").read_text())}]


def run_steps(workspace, names, reads="views/deep/{}.txt"):
    """A step that writes a file of each object, and one that reads it; returns what was run, in order."""
    log = workspace.root / "log"
    write_text(log, "")
    with StageRun(workspace, "views", inputs=("meshes",)) as run:
        run.each(functools.partial(write_item, log=log, data=workspace.data), names, reads=("meshes/{}.txt",))
        run.each(functools.partial(count_letters, made=run.folder, log=log), names, reads=(reads,))
    return log.read_text().split()


def test_a_step_runs_again_where_what_it_reads_of_an_earlier_one_has_changed(workspace):
    assert run_steps(workspace, "ab") == ["a", "b", "count-a", "count-b"]
    assert run_steps(workspace, "abc") == ["c", "count-c"]
    write_text(workspace.data / "meshes/b.txt", "other")
    assert run_steps(workspace, "abc") == ["b", "count-b"]
    with pytest.raises(UndeclaredRead, match="views/deep/a.txt is read, but not declared"):
        run_steps(workspace, "ab", reads="meshes/{}.txt")


def test_a_failed_run_keeps_the_old_folder_and_the_next_goes_on_where_it_stopped(workspace):
    run_items(workspace, "a")
    with pytest.raises(RuntimeError):
        run_items(workspace, "ab", broken=True)
    assert set(made(workspace)) == {"a"}
    assert run_items(workspace, "abc") == ["c"]


def test_a_damaged_entry_is_made_again_and_said(workspace, capsys):
    run_items(workspace)
    for path in (workspace.build / "objects").rglob("*.zip"):
        content = bytearray(path.read_bytes())
        content[len(content) // 3] ^= 255
        path.write_bytes(bytes(content))
    assert set(run_items(workspace)) == set("abc") and set(made(workspace)) == set("abc")
    assert "is damaged" in capsys.readouterr().err


def test_a_run_without_rows_leaves_a_table_of_headings(workspace):
    with StageRun(workspace, "views") as run:
        run.metrics({})
    table = read_rows(workspace.measurements / "views.csv.gz")
    assert table.empty and {"item", "metric", "value"} <= set(table)


def refuse(name, folder):
    raise ValueError("too small")


def test_an_error_names_the_object(workspace):
    with pytest.raises(ValueError, match="b c: too small"), StageRun(workspace, "views") as run:
        run.each(refuse, ["b c"])


def test_missing_input_names_the_stage_to_run(workspace):
    fault = "toys/lod is not there: run `dvc repro lod@toys` first"
    with pytest.raises(ValueError, match=fault), StageRun(workspace, "views", inputs=("lod",)):
        pass


@pytest.mark.slow
def test_what_a_person_did_ends_in_one_line_with_the_traceback_on_request():
    program = "from haptic_glance.base.errors import errors_in_one_line\nerrors_in_one_line('demo')\n"
    options = {"capture_output": True, "text": True, "cwd": ROOT}
    line = [sys.executable, "-c", f"{program}raise KeyboardInterrupt"]
    process = subprocess.run(line, env={**os.environ, "HAPTIC_GLANCE_DEBUG": ""}, **options)
    assert (process.stderr, process.returncode) == ("demo: stopped\n", -signal.SIGINT)
    process = subprocess.run(line, env={**os.environ, "HAPTIC_GLANCE_DEBUG": "1"}, **options)
    assert "Traceback" in process.stderr


def dies_at_b(name, folder, root):
    """Writes a file; the first call for `b` kills its process."""
    with open(root / "log", "a") as log:
        log.write(name)
    write_text(folder / name, name)
    if name == "b" and not (root / "died").exists():
        (folder / ".part-half").write_text("x")
        (root / "died").touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return [{"item": name, "metric": "m", "value": 1, "seconds": 0}]


def run_dying(workspace):
    with StageRun(workspace, "views") as run:
        run.each(functools.partial(dies_at_b, root=workspace.root), "abc")


def test_a_killed_run_leaves_nothing_in_place_and_the_next_goes_on(workspace):
    process = multiprocessing.get_context("fork").Process(target=run_dying, args=[workspace])
    process.start()
    process.join()
    assert process.exitcode == -signal.SIGKILL and not (workspace.data / "views").exists()
    run_dying(workspace)
    files = {path.name: path.read_text() for path in (workspace.data / "views").iterdir()}
    assert files == {"a": "a\n", "b": "b\n", "c": "c\n"} and (workspace.root / "log").read_text() == "abbc"
