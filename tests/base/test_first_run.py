"""The first run on a machine: what compiles beside it, and what may go wrong there."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
import trimesh

from haptic_glance import first_run
from haptic_glance.base.kept import cache_folder, claim, is_kept, kept_in, marker

fcntl = pytest.importorskip("fcntl")

KERNEL = """from haptic_glance.base.jit import kernel_of


@kernel_of(__file__)
def double(x):
    return 2 * x
"""
USER = "import kernels; assert kernels.double({}) == {}; print(sum(kernels.double.stats.cache_misses.values()))"


@pytest.fixture
def kernels(tmp_path, monkeypatch):
    """The file of one kernel, and an empty cache."""
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    (tmp_path / "code").mkdir()
    file = tmp_path / "code/kernels.py"
    file.write_text(KERNEL)
    return file


def user(file, number=3):
    """A process that calls the kernel and prints how often it compiled."""
    path = os.pathsep.join([str(file.parent), str(first_run.PACKAGE.parent)])
    line = [sys.executable, "-c", USER.format(number, 2 * number)]
    return subprocess.Popen(line, stdout=subprocess.PIPE, text=True, env=os.environ | {"PYTHONPATH": path})


@pytest.mark.slow
def test_of_two_processes_that_need_a_kernel_at_once_one_compiles_it(kernels):
    held = claim(marker(kernels, "double", kept_in(kernels)))
    assert held is not None
    users = [user(kernels), user(kernels)]
    time.sleep(3)
    assert all(process.poll() is None for process in users)  # they wait for the one that has the marker
    held.close()
    assert sorted(process.communicate(timeout=120)[0].strip() for process in users) == ["0", "1"]
    assert is_kept(kernels, "double")


def test_the_marker_of_a_process_that_was_killed_does_not_hold(kernels):
    path = marker(kernels, "double", kept_in(kernels))
    code = f"import time; from haptic_glance.base.kept import *; x = claim(Path({str(path)!r})); print(1, flush=True)"
    line = [sys.executable, "-c", f"{code}; time.sleep(600)"]
    environment = os.environ | {"PYTHONPATH": str(first_run.PACKAGE.parent)}
    with subprocess.Popen(line, stdout=subprocess.PIPE, env=environment) as holder:
        try:
            assert holder.stdout is not None and holder.stdout.readline() == b"1\n"
            assert claim(path, patience=0.1) is None
        finally:
            holder.kill()
    assert path.exists() and claim(path, patience=0) is not None


@pytest.mark.slow
def test_a_kernel_that_does_not_compile_leaves_its_marker_to_the_next_call(kernels):
    import importlib.util

    kernels.write_text(KERNEL.replace("2 * x", "x.none"))
    spec = importlib.util.spec_from_file_location("kernels", kernels)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for number in (1, 1.5):
        with pytest.raises(Exception, match="none"):
            module.double(number)


def test_helpers_are_started_only_where_kernels_are_missing(tmp_path, monkeypatch, capsys):
    started = []
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path))
    monkeypatch.setattr(first_run, "_cores", lambda: 2)
    monkeypatch.setattr(first_run.subprocess, "Popen", lambda *line, **_: started.append(line) or Dead)
    first_run.start("demo")
    count = len(first_run.COMMANDS["demo"])
    assert len(started) == 1 and capsys.readouterr().err == f"demo: compiling {count} of {count} kernels, once\n"
    for file, name, _ in first_run.COMMANDS["demo"]:
        folder = kept_in(first_run.PACKAGE / f"{file}.py")
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{Path(file).name}.{name}-1.py311.1.nbc").touch()
    first_run.start("demo")
    assert len(started) == 1 and not capsys.readouterr().err
    next(tmp_path.rglob("*.nbc")).unlink()
    monkeypatch.setattr(first_run, "_cores", lambda: 1)
    first_run.start("demo")
    assert len(started) == 1 and f"compiling 1 of {count} kernels" in capsys.readouterr().err


class Dead:
    """A process that has ended."""

    kill = wait = staticmethod(lambda: None)


@pytest.mark.slow
def test_a_kernel_compiles_beside_a_command_though_its_file_imports_scipy(tmp_path, monkeypatch):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path))
    only = "first_run.COMMANDS['demo'] = [kernel for kernel in first_run.LOOK if kernel[1] == '_average']"
    code = f"from haptic_glance import first_run; {only}; first_run.compile_all('demo')"
    environment = os.environ | {"PYTHONPATH": str(first_run.PACKAGE.parent)}
    subprocess.run([sys.executable, "-c", code], env=environment, check=True, timeout=300)
    assert is_kept(first_run.PACKAGE / "look/glance/samples.py", "_average")


def test_a_cache_that_cannot_be_written_to_is_named_with_the_remedy(kernels, monkeypatch, capsys):
    cache = kernels.parent / "cache"
    cache.write_text("no folder")
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(cache))
    monkeypatch.setattr(first_run.subprocess, "Popen", lambda *_, **__: pytest.fail("started"))
    first_run.start("demo")
    message = capsys.readouterr().err
    assert message.count("\n") == 1 and str(cache) in message and "set HAPTIC_GLANCE_CACHE" in message


def test_help_and_other_commands_start_nothing(monkeypatch):
    from haptic_glance.__main__ import run

    monkeypatch.setattr(first_run, "start", lambda _: pytest.fail("started"))
    with pytest.raises(SystemExit):
        run("demo", ["--help"])
    with pytest.raises(SystemExit):
        run("points", ["--help"])


ASKED = """
import sys
import numba
from haptic_glance import __main__, first_run
from haptic_glance.base.jit import Shared

# `similarity` needs OpenCV, which only an extra installs.
asked, real = set(), Shared.load_overload
def load(self, types, context):
    asked.add((self._py_func.__module__, self._py_func.__qualname__, types))
    return real(self, types, context)
Shared.load_overload = load
first_run.start = lambda command: None
__main__.run(sys.argv[1], sys.argv[2:])
known = vars(numba.types) | {first_run.SURFACE: first_run._surface()}
listed = {
    ("haptic_glance." + file.replace("/", "."), name, eval(f"({types})", known))
    for file, name, types in first_run.COMMANDS[sys.argv[1]]
}
print({kernel for kernel in asked ^ listed if kernel[0] != "haptic_glance.base.similarity"})
"""


@pytest.mark.slow
@pytest.mark.parametrize("command", ["demo", "simplify", "touch"])
def test_the_kernels_of_a_list_are_just_those_of_its_command(command, tmp_path):
    """In a cache that has only these, as far as the machine has them; a full one makes the demo use others."""
    if command == "touch":
        pytest.importorskip("matplotlib")
    for file, name, _ in first_run.COMMANDS[command]:
        folder = kept_in(first_run.PACKAGE / f"{file}.py")
        copy = tmp_path / folder.relative_to(cache_folder())
        copy.mkdir(parents=True, exist_ok=True)
        for kept in folder.glob(f"{Path(file).name}.{name}-*"):
            shutil.copy(kept, copy)
    mesh = [] if command == "demo" else [str(tmp_path / "ball.ply")]
    trimesh.creation.icosphere(3).export(tmp_path / "ball.ply")
    levels = ["--levels", "50%,10%"] if command == "simplify" else []
    printed = in_process(ASKED, tmp_path, command, *mesh, *levels, "--out", str(tmp_path / "out"))
    assert printed.splitlines()[-1] == "set()"
    if command == "demo":
        assert "6 places, 3 levels, 6 imprints" in printed and printed.count("  haptic-glance ") == 3
        assert (tmp_path / "out/dromedary/dromedary_10pct.glb").is_file()


@pytest.mark.slow
def test_a_helper_compiles_what_is_missing(tmp_path):
    file, name, types = next(kernel for kernel in first_run.LIGHT if kernel[0] == "mesh/kernels/planes")
    code = f"first_run.COMMANDS = {{'demo': [{(file, name, types)!r}]}}; first_run.compile_all('demo')"
    code = f"from haptic_glance import first_run; {code}"
    for _ in range(2):  # the second finds it
        in_process(code, tmp_path)
        assert [path.name.split("-")[0] for path in tmp_path.rglob("*.nbc")] == [f"{Path(file).name}.{name}"]


def in_process(code, cache, *arguments):
    """The standard output of code in a fresh interpreter with a cache."""
    environment = os.environ | {"HAPTIC_GLANCE_CACHE": str(cache), "PYTHONPATH": str(first_run.PACKAGE.parent)}
    line = [sys.executable, "-c", code, *arguments]
    return subprocess.run(line, env=environment, stdout=subprocess.PIPE, text=True, check=True).stdout
