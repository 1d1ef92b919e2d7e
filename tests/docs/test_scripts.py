"""The tutorials and examples of the documentation: they run, they are short, and they draw something."""

import ast
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


def code_lines(path):
    """Lines of a script that are neither empty, comments nor its docstring."""
    source = path.read_text(encoding="utf-8")
    body = ast.parse(source).body[1:]
    lines = source.splitlines()[body[0].lineno - 1 :]
    return [line for line in lines if line.strip() and not line.lstrip().startswith("#")]


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


def test_there_are_short_examples_that_begin_with_a_title_and_a_text():
    assert len(EXAMPLES) >= 20 and len(TUTORIALS) == 6
    for path in EXAMPLES + TUTORIALS:
        title, rule, empty, *text = (ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or "").splitlines()
        assert set(rule) == {"="} and len(rule) == len(title) and not empty and len(" ".join(text)) > 60, path
    assert all(8 <= len(code_lines(path)) <= 45 for path in EXAMPLES)


@pytest.mark.parametrize("path", TUTORIALS, ids=name)
def test_a_tutorial_says_what_it_needs(path):
    tree = ast.parse(path.read_text(encoding="utf-8"))
    names = [node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    names += [alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names]
    tops = {module.partition(".")[0] for module in names if module}
    needed = {EXTRAS[top] for top in tops if top in EXTRAS} | ({"pipeline"} if "stages" in tops else set())
    most = next(extra for extra in ("pipeline", "pictures") if extra in needed)  # each includes the next
    text = ast.get_docstring(tree) or ""
    assert f"[{most}]'``" in text and ("Needs a clone" in text) == (most != "pictures") and "without a network" in text
