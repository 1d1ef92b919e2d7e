"""Warming up, and where the compiled kernels are kept."""

import numba
import pytest

from haptic_glance.touch import warm_up as warm
from haptic_glance.touch.kernels import faces
from stages.imprints import __main__ as stage


def test_it_works_once_a_process(monkeypatch):
    touched = []
    monkeypatch.setitem(warm.__wrapped__.__globals__, "press", lambda *touch: touched.append(touch))
    warm.cache_clear()
    warm()
    warm()
    assert len(touched) == 1


def test_the_stage_warms_up_before_it_reads_the_object(monkeypatch, tmp_path):
    order = []
    monkeypatch.setattr(stage, "warm_up", lambda: order.append("warm"))
    monkeypatch.setattr(stage, "read_mesh", lambda path: order.append("read") or (_ for _ in ()).throw(OSError))
    with pytest.raises(OSError):
        stage.process("ball", tmp_path, tmp_path, None)
    assert order == ["warm", "read"]


def test_a_kernel_leaves_the_folder_of_other_kernels_as_it_was(monkeypatch):
    numba.config.reload_config()  # numba reads the environment again when it compiles after a test changed it
    monkeypatch.setattr(numba.config, "CACHE_DIR", "elsewhere")
    assert faces.kernel(abs_of)(-2.0) == 2.0
    assert numba.config.CACHE_DIR == "elsewhere"


def abs_of(value):
    """A function to compile."""
    return abs(value)
