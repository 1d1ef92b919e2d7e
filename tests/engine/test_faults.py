"""Faults: full disks, a damaged index, two runs at once, a cut network: nothing is lost, and one line says it."""

import errno
import json
import os
import sqlite3
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from haptic_glance.base import files
from haptic_glance.base.errors import errors_in_one_line
from stages.engine.objects import Objects, archive
from stages.engine.run import StageRun
from stages.repro import forget_killed, run_alone


def full(*_):
    raise OSError(errno.ENOSPC, "No space left on device")


@pytest.fixture
def workspace(make_workspace):
    return make_workspace({"views": {}})


def test_a_full_disk_is_named_with_the_file_and_leaves_nothing_half(tmp_path):
    with (
        pytest.raises(OSError, match="No space left on device: .*a.txt") as error,
        files.whole_file(tmp_path / "a.txt"),
    ):
        full()
    assert error.value.errno == errno.ENOSPC and not list(tmp_path.iterdir())


@pytest.mark.parametrize(("number", "remedy"), [(errno.ENOSPC, "make room on that disk"), (errno.EROFS, "writable")])
def test_errors_of_the_disk_end_in_one_line_with_a_remedy(number, remedy, monkeypatch, capsys):
    monkeypatch.setattr(sys, "excepthook", sys.excepthook)
    errors_in_one_line("demo")
    sys.excepthook(OSError, OSError(number, "why\nnot", "a.npz"), None)
    message = capsys.readouterr().err
    assert message.startswith(f"demo: [Errno {number}] why") and "a.npz" in message and remedy in message
    assert message.count("\n") == 1


@pytest.mark.parametrize(
    ("output", "status"),
    [("import time\nwhile True: print('x' * 100_000, flush=True), time.sleep(0.01)", 1), ("input(), print('x')", 0)],
)
def test_a_reader_that_goes_ends_a_command_in_silence(output, status):
    program = f"from haptic_glance.base.errors import errors_in_one_line\nerrors_in_one_line('demo')\n{output}"
    pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    buffered = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    with subprocess.Popen([sys.executable, "-c", program], **pipes, env=buffered, text=True) as process:
        process.stdout.close()
        process.stdin.write("\n")
        process.stdin.close()
        assert process.stderr.read() == ""
    assert process.returncode == status


def test_a_broken_pipe_that_is_not_the_output_has_its_line(monkeypatch, capsys):
    monkeypatch.setattr(sys, "excepthook", sys.excepthook)
    errors_in_one_line("demo")
    sys.excepthook(BrokenPipeError, BrokenPipeError(errno.EPIPE, "Broken pipe"), None)
    assert capsys.readouterr().err == "demo: [Errno 32] Broken pipe\n"


@pytest.mark.parametrize(
    ("code", "number"), [(sqlite3.SQLITE_FULL, errno.ENOSPC), (sqlite3.SQLITE_READONLY, errno.EROFS)]
)
def test_a_full_or_read_only_disk_is_no_damage_of_the_cache(code, number, tmp_path, monkeypatch):
    kept = Objects(tmp_path / "cache")
    kept.keep("k", archive([{"value": 1}], tmp_path / "none"))

    def refuse(*_, **__):
        error = sqlite3.OperationalError("refused")
        error.sqlite_errorcode = code
        raise error

    with monkeypatch.context() as patched:
        patched.setattr("diskcache.Cache.get", refuse)
        with pytest.raises(OSError, match="cache") as error:
            kept.take("k", tmp_path / "to")
    assert error.value.errno == number and kept.take("k", tmp_path / "to") == [{"value": 1}]


def test_a_data_folder_that_cannot_be_written_to_is_named_before_any_work(workspace, monkeypatch):
    monkeypatch.setattr("stages.engine.run.os.access", lambda path, mode: path != workspace.data or mode != os.W_OK)
    with (
        pytest.raises(ValueError, match="data/toys cannot be written to: make it writable"),
        StageRun(workspace, "views"),
    ):
        pass


def other_disk(self, target):
    """Path.rename, between two folders as if they lay on two disks."""
    if self.parent != Path(target).parent:
        raise OSError(errno.EXDEV, "Invalid cross-device link", str(self))
    os.rename(self, target)


def test_a_folder_reaches_another_disk_whole_and_replaces_what_is_there(tmp_path, monkeypatch):
    monkeypatch.setattr(Path, "rename", other_disk)
    source, target = tmp_path / "a/lod", tmp_path / "b/lod"
    files.write_text(source / "deep/x", "new")
    files.write_text(target / "old", "old")
    files.write_text(target.with_name(f"{files.PART}lod") / "half", "half")
    files.replace_folder(source, target)
    assert (target / "deep/x").read_text() == "new\n"
    assert [path.name for path in target.parent.iterdir()] == ["lod"] and not (target / "old").exists()
    assert not source.exists() and not (target / "half").exists()


def test_another_disk_that_is_full_keeps_what_was_there(tmp_path, monkeypatch):
    monkeypatch.setattr(Path, "rename", other_disk)
    monkeypatch.setattr("haptic_glance.base.files.shutil.copyfile", full)
    files.write_text(tmp_path / "a/lod/x", "new")
    files.write_text(tmp_path / "b/lod/x", "old")
    with pytest.raises(OSError, match="No space left"):
        files.replace_folder(tmp_path / "a/lod", tmp_path / "b/lod")
    assert (tmp_path / "b/lod/x").read_text() == "old\n" and len(list((tmp_path / "b").iterdir())) == 1


def test_a_second_run_says_that_it_waits_and_begins_when_the_first_ends(workspace, capfd):
    order = []

    def second():
        with StageRun(workspace, "views"):
            order.append("second")

    thread, message, end = threading.Thread(target=second), "", time.monotonic() + 300
    with StageRun(workspace, "views"):
        thread.start()
        while "views toys: waits for another run of the same to end" not in message:
            assert time.monotonic() < end
            time.sleep(0.01)
            message += capfd.readouterr().err
        order.append("first")
    thread.join()
    assert order == ["first", "second"]


def test_a_failed_run_leaves_the_place_free(workspace):
    for _ in range(2):
        with pytest.raises(ZeroDivisionError), StageRun(workspace, "views"):  # a lock held twice is a RuntimeError
            raise ZeroDivisionError


@pytest.mark.parametrize("text", ['{"write": {', "", "[]", '{"read": {"a": [{"pid": 1}]}}'])
def test_a_damaged_list_of_dvcs_runs_is_removed(text, tmp_path):
    (tmp_path / "rwlock").write_text(text)
    forget_killed(tmp_path / "rwlock", "repro")
    assert not (tmp_path / "rwlock").exists()
    forget_killed(tmp_path / "rwlock", "repro")


def test_dvc_forgets_the_stages_of_a_killed_run_and_no_others(tmp_path):
    killed, other = {"pid": 1, "cmd": "repro"}, {"pid": 2, "cmd": "dvc repro"}
    listed = {"read": {"a": [killed, other], "b": [killed]}, "write": {"c": killed, "d": other}}
    (tmp_path / "rwlock").write_text(json.dumps(listed))
    forget_killed(tmp_path / "rwlock", "repro")
    assert json.loads((tmp_path / "rwlock").read_text()) == {"read": {"a": [other]}, "write": {"d": other}}


@pytest.fixture
def repository(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # DVC names stages by their place from here
    subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)
    (tmp_path / ".dvc").mkdir()
    (tmp_path / ".dvc/config").write_text("[core]\n    analytics = false\n")
    (tmp_path / "params.yaml").write_text("who: all\n")
    (tmp_path / "dvc.yaml").write_text('stages:\n  a: {cmd: "echo ${who} > a", outs: [a]}\n')
    return tmp_path


@pytest.mark.slow
def test_damaged_settings_are_named_with_the_remedy(repository):
    (repository / "params.yaml").write_bytes(b"\x00garbage: [")
    with pytest.raises(ValueError, match="params.yaml.*stages.compose"):
        run_alone(Path("."))


@pytest.mark.slow
def test_half_a_dvc_lock_gives_way_to_the_last_sound_one(repository, capfd):
    assert run_alone(Path(".")) == []
    sound = (repository / "dvc.lock").read_text()
    for damage in (b"", b"schema: '2.0'\nstages:\n  a:\n    cm", b"\xff"):
        (repository / "dvc.lock").write_bytes(damage)
        capfd.readouterr()
        assert run_alone(Path(".")) == [] and (repository / "dvc.lock").read_text() == sound
        captured = capfd.readouterr()
        assert "dvc.lock is damaged" in captured.err and captured.out == ""  # no stage ran again
        assert (repository / "build/damaged.lock").read_bytes() == damage
