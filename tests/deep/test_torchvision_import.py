"""torchvision imports, whatever build of torch is beside it."""

import subprocess
import sys

import pytest
import torch

from haptic_glance.deep import architectures as vision


@pytest.mark.slow
def test_models_build_and_run_in_a_fresh_process():
    code = (
        "from haptic_glance.deep.architectures import torchvision\n"
        "import torch\n"
        "net = torchvision.models.mobilenet_v2(num_classes=3).eval()\n"
        "print(tuple(net(torch.zeros(1, 3, 32, 32)).shape), len(torchvision.models.list_models()) > 50)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.strip() == "(1, 3) True", done.stderr


def test_nothing_is_declared_where_the_import_works(monkeypatch):
    monkeypatch.setattr(vision, "_declared", [])
    monkeypatch.setattr(vision.importlib, "import_module", lambda name: name)
    assert vision.load() == "torchvision"
    assert not vision._declared


def test_schemas_are_declared_after_the_known_failure_only_and_half_modules_dropped(monkeypatch):
    calls, modules = [], {"torchvision": 1, "torchvision.extension": 1, "torchvision_other": 1, "sys": sys}

    def half_import(name):
        calls.append(name)
        if len(calls) == 1:
            raise RuntimeError("operator torchvision::nms does not exist")
        return "second"

    class Library:
        def __init__(self, namespace, kind):
            self.made = [namespace, kind]

        def define(self, schema):
            self.made.append(schema.partition("(")[0])

    monkeypatch.setattr(vision, "_declared", [])
    monkeypatch.setattr(vision.sys, "modules", modules)
    monkeypatch.setattr(vision.importlib, "import_module", half_import)
    monkeypatch.setattr(torch.library, "Library", Library)
    assert vision.load() == "second"
    assert set(modules) == {"torchvision_other", "sys"}
    assert vision._declared[0].made == ["torchvision", "FRAGMENT", "nms", "qnms"]


def test_another_failure_is_told_with_its_remedy(monkeypatch):
    def broken(name):
        raise RuntimeError("libcudart is too old")

    monkeypatch.setattr(vision, "_declared", [])
    monkeypatch.setattr(vision.importlib, "import_module", broken)
    with pytest.raises(ImportError, match="libcudart is too old.*constraints.txt"):
        vision.load()
