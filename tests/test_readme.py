"""README.md: short, and right about files, commands, code and figures."""

import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

import stages
from haptic_glance.__main__ import OWN
from stages.compose import groups
from stages.report.cells import number_of, rows_of

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
CODE = re.compile(r"^```(\w+)\n(.*?)^```$", re.M | re.S)
LINK = re.compile(r"\[[^\]]*\]\((?!https?:)([^)\s]+)(?: \"([^\"]*)\")?\)")
# 45 [31, 60]: a figure with its interval
FIGURE = re.compile(r"([+-]?[\d,.]+) \[([+-]?[\d,.]+), ([+-]?[\d,.]+)\]")
WITH_FIGURES = [line for line in TEXT.splitlines() if FIGURE.search(line)]
RESULTS, FAILURES = 5, 6


def shown(number, like):
    """A number as the README would print it: with the decimals, commas and sign of a text."""
    places = len(like.partition(".")[2])
    return f"{number:{'+' if like[0] == '+' else ''},.{places}f}"


def paragraphs():
    """The texts between blank lines; each item of a list is one; code and tables are none."""
    blocks = re.split(r"\n\s*\n|\n(?=- )", CODE.sub("", TEXT))
    return [block for block in blocks if block.strip() and not block.lstrip().startswith(("|", "#", "!["))]


@pytest.mark.parametrize("line", WITH_FIGURES, ids=lambda line: line.strip("| ")[:40])
def test_every_figure_is_that_of_its_table(line):
    """The title of a link to a CSV names the cells behind the figure, as stages.report.cells has them."""
    (texts,) = FIGURE.findall(line)
    ((path, title),) = [link for link in LINK.findall(line) if link[1]]
    where, _, columns = title.partition(": ")
    numbers = [number_of(rows_of(ROOT / path, where), column) for column in columns.split()]
    assert list(texts) == [shown(number, text) for number, text in zip(numbers, texts, strict=True)]


def test_results_and_failures_have_intervals():
    sections = dict(re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", TEXT, re.M | re.S))
    assert len(FIGURE.findall(sections["Results"])) == RESULTS
    assert len(FIGURE.findall(sections["Where it fails"])) == FAILURES
    assert len(WITH_FIGURES) == RESULTS + FAILURES


def test_the_readme_is_short():
    assert len(TEXT.splitlines()) <= 130
    long = [text for text in paragraphs() if len(text.split()) > 100]
    assert not long and len(paragraphs()) > 10


def test_a_sentence_has_one_figure_at_most():
    sentences = re.split(r"(?<=[.:!?])\s", " ".join(paragraphs()))
    assert not [text for text in sentences if len(re.findall(r"(?<![\w.])\d+(?:\.\d+)?(?: %| points)", text)) > 1]


@pytest.mark.parametrize("path", sorted({path for path, _ in LINK.findall(TEXT)}))
def test_every_link_leads_to_a_file(path):
    assert (ROOT / path).exists()


def test_every_command_is_there():
    code = "\n".join(text for _, text in CODE.findall(TEXT))
    modules = set(re.findall(r"python -m stages\.([\w.]+)", TEXT))
    assert modules and all(find_spec(f"stages.{name}") for name in modules)
    assert set(re.findall(r"haptic-glance (\w+)", code)) <= {*OWN}
    made = set(re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(), re.M))
    assert {"repro", "test"} <= set(re.findall(r"^make (\w+)", code, re.M)) <= made
    options = re.findall(r"\b(experiment|profile|parallel|classifier)=([\w,]+)", TEXT)
    assert options and all(set(names.split(",")) <= set(groups()[group]) for group, names in options)


@pytest.mark.slow
def test_the_python_example_runs(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=4)
    ball.vertices *= [40.0, 28.0, 20.0]
    ball.vertices[:, 2] += 0.005 * ball.vertices[:, 0] ** 2
    ball.export(tmp_path / "scan.stl")
    ((_, code),) = [block for block in CODE.findall(TEXT) if block[0] == "python"]
    check = "assert values.shape == (2562,) and len(points) and len(small.faces) <= 1500 and image.shape == (16, 16)"
    environment = os.environ | {"PYTHONPATH": str(Path(stages.__path__[0]).parent)}
    command = [sys.executable, "-c", f"{code}\n{check}"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
