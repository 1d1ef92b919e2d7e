"""Faults: full disks, a damaged index, two runs at once, a cut network: nothing is lost, and one line says it."""

import errno
import functools
import hashlib
import http.server
import json
import os
import signal
import sqlite3
import subprocess
import sys
import threading
import time
import zipfile
from pathlib import Path

import pytest

from haptic_glance.base import fetch, files
from haptic_glance.base.errors import errors_in_one_line
from stages.engine.dvc_files import forget_killed
from stages.engine.objects import Objects, archive
from stages.engine.run import StageRun, alone
from stages.repro import run_alone

ROOT = Path(__file__).parents[2]
TWICE = """
import sys, time
from pathlib import Path
from stages.engine.dvc_files import forget_killed
from haptic_glance.base.files import write_text
from stages.engine.run import StageRun
from stages.engine.settings import Workspace
def item(name, folder):
    write_text(folder / name, name)
    while not Path("go").exists():
        time.sleep(0.01)
    return [{"item": name, "metric": "m", "value": 1}]
with StageRun(Workspace(Path("."), "toys"), "views") as run:
    run.each(item, ["a", "b", "c"])
"""


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
    said = capsys.readouterr().err
    assert said.startswith(f"demo: [Errno {number}] why") and "a.npz" in said and remedy in said
    assert said.count("\n") == 1


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


def test_what_cannot_be_unpacked_for_want_of_room_is_no_damage(tmp_path, monkeypatch, capsys):
    (tmp_path / "from").mkdir()
    (tmp_path / "from/x").write_text("x")
    kept = Objects(tmp_path / "cache")
    kept.keep("k", archive([], tmp_path / "from"))
    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="No space left"):
        kept.take("k", tmp_path / "to")
    assert "damaged" not in capsys.readouterr().err


def test_damaged_pages_of_the_index_are_begun_anew(tmp_path, capsys):
    kept = Objects(tmp_path / "cache")
    kept.keep("k", archive([{"value": 1}], tmp_path / "none"))
    index = tmp_path / "cache/cache.db"
    with sqlite3.connect(index) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    connection.close()
    content = bytearray(index.read_bytes())
    content[4096:-4096] = b"\xff" * (len(content) - 8192)
    index.write_bytes(content)
    assert kept.take("k", tmp_path / "to") is None and "begun anew" in capsys.readouterr().err
    kept.keep("k", archive([{"value": 2}], tmp_path / "none"))
    assert kept.take("k", tmp_path / "to") == [{"value": 2}]


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


def test_a_second_run_says_that_it_waits_and_begins_when_the_first_ends(tmp_path, capfd):
    order = []

    def second():
        with alone(tmp_path / "lock", "demo"):
            order.append("second")

    thread = threading.Thread(target=second)
    with alone(tmp_path / "lock", "first"):
        thread.start()
        end = time.monotonic() + 10
        while "demo: waits" not in capfd.readouterr().err and time.monotonic() < end:
            time.sleep(0.01)
        order.append("first")
    thread.join(10)
    assert order == ["first", "second"] and time.monotonic() < end


def test_a_failed_run_leaves_the_place_free(workspace):
    for _ in range(2):
        with pytest.raises(ZeroDivisionError), StageRun(workspace, "views"):  # a lock held twice is a RuntimeError
            raise ZeroDivisionError


@pytest.mark.slow
def test_two_runs_of_one_stage_at_once_end_with_the_same_whole_folder(workspace):
    environment, said = {**os.environ, "PYTHONPATH": str(ROOT)}, workspace.root / "said"
    with said.open("w") as errors:
        command = [sys.executable, "-c", TWICE]
        runs = [subprocess.Popen(command, env=environment, cwd=workspace.root, stderr=errors) for _ in range(2)]
    end = time.monotonic() + 60
    while not said.read_text() and time.monotonic() < end:
        time.sleep(0.01)
    (workspace.root / "go").touch()
    assert [run.wait(60) for run in runs] == [0, 0], said.read_text()
    assert said.read_text() == "views toys: waits for another run of the same to end\n"
    assert {path.name for path in (workspace.data / "views").iterdir()} == set("abc")


@pytest.mark.slow
def test_a_killed_run_leaves_the_place_free(workspace):
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    first = subprocess.Popen([sys.executable, "-c", TWICE], env=environment, cwd=workspace.root)
    end = time.monotonic() + 30
    while not (workspace.build / "scratch").exists() and time.monotonic() < end:
        time.sleep(0.01)
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    (workspace.root / "go").touch()
    subprocess.run([sys.executable, "-c", TWICE], env=environment, cwd=workspace.root, check=True, timeout=60)
    assert {path.name for path in (workspace.data / "views").iterdir()} == set("abc")


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
    with pytest.raises(ValueError, match="params.yaml.*from git again"):
        run_alone(Path("."))


@pytest.mark.slow
@pytest.mark.parametrize("damage", [b"", b"schema: '2.0'\nstages:\n  a:\n    cm", b"\xff"])
def test_half_a_dvc_lock_gives_way_to_the_last_sound_one(damage, repository, capfd):
    assert run_alone(Path(".")) == []
    sound = (repository / "dvc.lock").read_text()
    (repository / "dvc.lock").write_bytes(damage)
    capfd.readouterr()
    assert run_alone(Path(".")) == [] and (repository / "dvc.lock").read_text() == sound
    said = capfd.readouterr()
    assert "dvc.lock is damaged" in said.err and said.out == ""  # no stage ran again
    assert (repository / "build/damaged.lock").read_bytes() == damage


class Cut(http.server.BaseHTTPRequestHandler):
    """A package index of one wheel, of which it sends half."""

    def __init__(self, name, content, *rest):
        self.name, self.content = name, content
        super().__init__(*rest)

    def do_GET(self):  # noqa: N802  # the name that http.server asks for
        body = self.content if self.path.endswith(".whl") else f'<a href="/{self.name}">{self.name}</a>'.encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body[: len(body) // 2] if body is self.content else body)

    def log_message(self, *_):
        pass


@pytest.mark.slow
def test_a_connection_that_is_cut_leaves_nothing_in_the_cache_and_says_so(tmp_path, monkeypatch):
    name, wheel = "cut_wheel-1.0-py3-none-any.whl", tmp_path / "wheel"
    with zipfile.ZipFile(wheel, "w") as stored:
        stored.writestr("cut_wheel-1.0.dist-info/METADATA", "Metadata-Version: 2.1\nName: cut-wheel\nVersion: 1.0\n")
    content = wheel.read_bytes()
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Cut, name, content))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "kept"))
    for key, value in {
        "INDEX_URL": f"http://127.0.0.1:{server.server_port}/simple",
        "RETRIES": "0",
        "NO_INDEX": "0",
    }.items():
        monkeypatch.setenv(f"PIP_{key}", value)
    monkeypatch.setenv("PIP_CONFIG_FILE", os.devnull)
    try:
        with pytest.raises(fetch.FetchError, match="try again|incomplete|Incomplete|Connection broken"):
            fetch.fetch_package("cut-wheel==1.0", name, hashlib.sha256(content).hexdigest())
    finally:
        server.shutdown()
    assert not list((tmp_path / "kept").iterdir())
