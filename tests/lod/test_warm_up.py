"""Warming up: once a process and backend, and before the stage measures."""

import pytest

from haptic_glance.lod.simplify import simplify
from stages.lod import cell as module
from stages.lod import data_set


def test_it_works_once_for_each_backend(monkeypatch):
    asked = []

    def counted(mesh, faces, *rest, **options):
        asked.append((faces, options.get("backend")))
        return simplify(mesh, faces, *rest, **options)

    monkeypatch.setattr(module, "simplify", counted)
    module.warm_up.cache_clear()
    module.warm_up("fast")
    assert len(asked) == 2
    module.warm_up("fast")
    assert len(asked) == 2
    module.warm_up("pymeshlab")
    assert len(asked) == 4


def test_the_stage_warms_its_backend_up_before_it_reads_the_object(monkeypatch, tmp_path):
    order = []
    monkeypatch.setattr(data_set, "warm_up", order.append)
    monkeypatch.setattr(data_set, "read_mesh", lambda path: order.append("read") or (_ for _ in ()).throw(OSError))

    class Settings:
        backend = "fast"

    with pytest.raises(OSError):
        data_set.process("ball", tmp_path, tmp_path, Settings, 0, False)
    assert order == ["fast", "read"]
