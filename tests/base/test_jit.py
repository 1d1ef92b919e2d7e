"""Kernels: cached on disk by numba, and interpreted where that is faster."""

import importlib.util

import numba
import numpy as np
import pytest

from haptic_glance.base import jit
from haptic_glance.base.jit import UntilWorthCompiling, greater, kernel_folder, lesser

SOURCE = """from haptic_glance.base.jit import cached_njit


@cached_njit()
def double(x):
    return {}
"""


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(jit.config, "CACHE_DIR", "")
    kernel_folder.cache_clear()
    yield
    kernel_folder.cache_clear()


def double_in(folder, body):
    """The kernel of a module with such a body, written to a folder, as another process would have it."""
    folder.mkdir(exist_ok=True)
    (folder / "kernels.py").write_text(SOURCE.format(body))
    spec = importlib.util.spec_from_file_location("kernels", folder / "kernels.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.double


def hits_of(folder, body):
    """How many kernels of a module with such a body, written to a folder, were compiled before."""
    double = double_in(folder, body)
    assert double(3) == 6
    return sum(double.stats.cache_hits.values())


def test_a_kernel_is_found_by_the_next_process_and_renewed_with_its_file(tmp_path):
    assert hits_of(tmp_path / "one", "2 * x") == 0 and hits_of(tmp_path / "one", "2 * x") == 1
    assert hits_of(tmp_path / "one", "x + x") == 0
    assert [path for path in (tmp_path / "cache").rglob("*.nbc") if path.is_relative_to(kernel_folder())]


def test_a_kernel_runs_where_no_folder_can_be_written_to(tmp_path, monkeypatch):
    (tmp_path / "one").mkdir()
    for place in ("cache", "home", "one/__pycache__"):
        (tmp_path / place).write_text("no folder")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    assert hits_of(tmp_path / "one", "2 * x") == 0


@pytest.mark.slow
def test_processes_that_compile_at_once_do_not_mix_up_their_code(tmp_path, monkeypatch):
    ints, floats, reader = (double_in(tmp_path / "one", "2 * x") for _ in range(3))
    cache = ints._cache._cache_file
    late, save = [], cache._save_data
    monkeypatch.setattr(cache, "_save_data", lambda *code: late.append(code))  # it is slow to write its code
    assert ints(3) == 6
    monkeypatch.setattr(floats._cache._cache_file, "_load_index", dict)  # it looked before the other wrote the index
    assert floats(1.5) == 3
    save(*late[0])
    assert reader(1.5) == 3 and reader.stats.cache_hits


def test_little_work_is_interpreted_and_more_is_compiled(tmp_path):
    double = double_in(tmp_path / "one", "2 * x")
    few = UntilWorthCompiling(double, budget=10)
    assert few.for_work(4)(3) == few.for_work(5)(3) == 6 and not double.signatures
    assert few.for_work(2)(3) == 6 and double.signatures
    another = UntilWorthCompiling(double, budget=10)
    assert another.for_work(1) is double  # its machine code is kept
    eager = UntilWorthCompiling(double_in(tmp_path / "two", "x + x"), budget=10)
    eager.compile_always()
    assert isinstance(eager.for_work(0), numba.core.dispatcher.Dispatcher)


@pytest.mark.slow
def test_lesser_and_greater_are_min_and_max_bit_for_bit():
    @numba.njit
    def both(a, b):
        return lesser(a, b), greater(a, b)

    numbers = [0.0, -0.0, 1.5, -1.5, np.inf, -np.inf, np.nan, 3, -3]
    for a in numbers:
        for b in numbers:
            kind = float if isinstance(a, float) or isinstance(b, float) else int
            expected = kind(min(a, b)), kind(max(a, b))
            assert np.array(both(a, b)).tobytes() == np.array(expected).tobytes(), (a, b)
