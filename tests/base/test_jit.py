"""Compiled kernels on disk: found again by what their folder holds, wherever it lies."""

import importlib.util
import threading

import numba
import numpy as np
import pytest

from haptic_glance.base import jit, kept
from haptic_glance.base.jit import UntilCompiledBeside, UntilWorthCompiling, greater, helper, interpreted, lesser

SOURCE = """from haptic_glance.base.jit import kernel_of


@kernel_of(__file__)
def double(x):
    return {}
"""


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


@pytest.mark.slow
def test_processes_that_compile_at_once_do_not_mix_up_their_code(tmp_path, monkeypatch):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    ints, floats, reader = (double_in(tmp_path / "one", "2 * x") for _ in range(3))
    cache = ints._cache._cache_file
    late, save = [], cache._save_data
    monkeypatch.setattr(cache, "_save_data", lambda *code: late.append(code))  # it is slow to write its code
    assert ints(3) == 6
    monkeypatch.setattr(floats._cache._cache_file, "_load_index", dict)  # it looked before the other wrote the index
    assert floats(1.5) == 3
    save(*late[0])
    assert reader(1.5) == 3 and reader.stats.cache_hits


@pytest.mark.slow
def test_a_copy_finds_what_equal_sources_elsewhere_compiled(tmp_path, monkeypatch):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    assert hits_of(tmp_path / "one", "2 * x") == 0
    assert hits_of(tmp_path / "copy", "2 * x") == 1 and hits_of(tmp_path / "other", "x + x") == 0


def test_a_change_of_the_shared_helpers_renews_the_kernels_of_all_folders(tmp_path, monkeypatch):
    shared, file = [tmp_path / path.name for path in kept.SHARED], tmp_path / "one" / "kernels.py"
    for path in shared:
        path.touch()
    monkeypatch.setattr(kept, "SHARED", shared)
    folders = [kept.kept_in(file)]
    for path in shared:
        path.write_text("# another choice of passes, or another helper")
        folders.append(kept.kept_in(file))
    assert len(set(folders)) == 3


def test_a_cache_that_cannot_be_written_to_is_done_without(tmp_path, monkeypatch):
    (tmp_path / "cache").write_text("no folder")
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    assert hits_of(tmp_path / "one", "2 * x") == 0


@pytest.mark.parametrize("ending, share", [(".nbc", 0.5), (".nbc", 0), (".nbi", 0.5), (".nbi", 0), (".nbi", None)])
def test_a_damaged_kernel_is_compiled_anew_and_kept(tmp_path, monkeypatch, ending, share):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    assert hits_of(tmp_path / "one", "2 * x") == 0
    (kept_file,) = (tmp_path / "cache").rglob(f"*{ending}")
    content = kept_file.read_bytes()
    kept_file.write_bytes(b"no pickle" if share is None else content[: int(share * len(content))])
    assert hits_of(tmp_path / "one", "2 * x") == 0 and hits_of(tmp_path / "one", "2 * x") == 1


def test_little_work_is_interpreted_and_more_is_compiled(tmp_path, monkeypatch):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    double = double_in(tmp_path / "one", "2 * x")
    few = UntilWorthCompiling(double, str(tmp_path / "one/kernels.py"), budget=10)
    assert few.for_work(4)(3) == few.for_work(5)(3) == 6 and not double.signatures
    assert few.for_work(2)(3) == 6 and double.signatures
    another = UntilWorthCompiling(double, str(tmp_path / "one/kernels.py"), budget=10)
    assert another.for_work(1) is double  # its machine code is kept
    eager = UntilWorthCompiling(double, str(tmp_path / "empty/kernels.py"), budget=10)
    eager.compile_always()
    assert eager.for_work(0) is double


def test_a_kernel_is_interpreted_only_while_another_process_compiles_it_and_its_mesh_is_small(tmp_path, monkeypatch):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(kept, "beside", threading.Event())
    monkeypatch.setattr(jit, "beside", kept.beside)
    length = double_in(tmp_path / "one", "len(x)")
    kept.beside.set()
    few = UntilCompiledBeside(length, most=3)
    assert few(np.ones(3)) == 3 and not length.signatures
    assert few(np.ones(4)) == 4 and length.signatures  # the mesh is large: compiled, and kept
    ours = double_in(tmp_path / "one", "len(x)")
    assert UntilCompiledBeside(ours, most=3)(np.ones(3)) == 3 and sum(ours.stats.cache_hits.values())
    kept.beside.clear()
    alone = double_in(tmp_path / "two", "len(x) + 0")
    assert UntilCompiledBeside(alone, most=3)(np.ones(3)) == 3 and alone.signatures


def test_signatures_are_remembered_for_kernels_of_this_package_alone():
    original = numba.types.Function.get_call_type
    for package in ("somebody", "haptic_glance"):

        def total(x, y):
            return x + y

        total.__module__, before = f"{package}.kernels", len(jit.signatures)
        assert numba.njit(total)(np.float32(2), 3j) == 2 + 3j  # a pair of types that no other kernel adds
        assert (len(jit.signatures) > before) == (package == "haptic_glance")
        assert numba.types.Function.get_call_type is original


@helper
def clipped(x):
    return lesser(greater(x, 0.0), 1.0)


def add_clipped(x, total):
    for i in range(len(x)):
        total[i % 2] += clipped(x[i]) ** 2


@pytest.mark.slow
def test_a_kernel_with_fewer_passes_of_numba_computes_what_python_does(tmp_path, monkeypatch):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path))
    x, compiled, plain = np.linspace(-1, 2, 99), np.zeros(2), np.zeros(2)
    kernel = jit.kernel_of(__file__, forceinline=True, _nrt=False)(add_clipped)
    kernel(x, compiled)
    interpreted(kernel)(x, plain)
    np.testing.assert_array_equal(compiled, plain)


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
