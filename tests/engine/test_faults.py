"""Faults: full disks, two runs at once, a cut network: nothing is lost, and one line says it."""

import errno
import os
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


def test_what_was_not_used_for_longest_goes_first_when_the_cache_is_full(tmp_path):
    objects, content = Objects(tmp_path / "cache"), archive([{"value": 1}], tmp_path / "none")
    for number, key in enumerate("abc"):
        objects.keep(key, content)
        os.utime(objects.folder / key / f"{key}.zip", (number, number))
    assert objects.take("a", tmp_path) == [{"value": 1}]
    objects.trim(2 * len(content))
    assert [objects.take(key, tmp_path) for key in "abc"] == [[{"value": 1}], None, [{"value": 1}]]


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
