"""Compiled kernels on disk: found again by what their folder holds, wherever it lies."""

import importlib.util

import pytest

SOURCE = """from stages.kit.jit import kernel_of


@kernel_of(__file__)
def double(x):
    return {}
"""


def hits_of(folder, body):
    """How many kernels of a module with such a body, written to a folder, were compiled before."""
    folder.mkdir()
    (folder / "kernels.py").write_text(SOURCE.format(body))
    spec = importlib.util.spec_from_file_location("kernels", folder / "kernels.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert module.double(3) == 6
    return sum(module.double.stats.cache_hits.values())


@pytest.mark.slow
def test_a_copy_finds_what_equal_sources_elsewhere_compiled(tmp_path, monkeypatch):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    assert hits_of(tmp_path / "one", "2 * x") == 0
    assert hits_of(tmp_path / "copy", "2 * x") == 1 and hits_of(tmp_path / "other", "x + x") == 0


def test_a_cache_that_cannot_be_written_to_is_done_without(tmp_path, monkeypatch):
    (tmp_path / "cache").write_text("no folder")
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    assert hits_of(tmp_path / "one", "2 * x") == 0
