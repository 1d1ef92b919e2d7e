"""The tutorials and examples of the documentation: they run, they are short, and they draw something."""

import runpy
import socket
import sys
from pathlib import Path

import pytest

from haptic_glance.base import fetch
from haptic_glance.base.extras import EXTRAS
from stages.engine import statistics

plt = pytest.importorskip("matplotlib.pyplot")

DOCS = Path(__file__).parents[2] / "docs"
EXAMPLES = sorted((DOCS / "examples").glob("*/*.py"))
TUTORIALS = sorted((DOCS / "tutorials").glob("*.py"))


def name(path):
    return str(path.relative_to(DOCS))


@pytest.fixture
def without_network(monkeypatch):
    """An error where a script asks another machine, or fetches a file through pip, npm or apt-get."""

    def refuse(*asked, **_options):
        raise AssertionError(f"the network was asked: {asked}")

    monkeypatch.setattr(socket.socket, "connect", refuse)
    monkeypatch.setattr(socket, "getaddrinfo", refuse)
    monkeypatch.setattr(fetch, "_fetch", refuse)


@pytest.mark.slow
@pytest.mark.parametrize("path", EXAMPLES + TUTORIALS, ids=name)
def test_it_runs_and_draws(path, without_network, monkeypatch, tmp_path):
    drawn = []
    monkeypatch.setattr(plt, "show", lambda: drawn.extend(plt.get_fignums()) or plt.close("all"))
    monkeypatch.setattr(statistics, "RESAMPLES", 400)  # to which most of the time of a judgement goes
    monkeypatch.chdir(tmp_path)
    plt.switch_backend("agg")
    if "[pipeline]" not in path.read_text(encoding="utf-8"):  # a script names what it needs beyond [pictures]
        for package in ("stages", *(top for top, extra in EXTRAS.items() if extra == "pipeline")):
            monkeypatch.setitem(sys.modules, package, None)
    runpy.run_path(str(path), run_name="__main__")
    assert drawn and not list(tmp_path.iterdir())
