"""README.md: short, and right about files, commands, code and figures."""

import re
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import trimesh

from haptic_glance.__main__ import MESH_COMMANDS
from haptic_glance.mesh.mesh import Mesh
from stages.charts.cells import number_of, rows_of
from stages.compose import groups

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
CODE = re.compile(r"^```(\w+)\n(.*?)^```$", re.M | re.S)
LINK = re.compile(r"\[[^\]]*\]\((?!https?:)([^)\s]+)(?: \"([^\"]*)\")?\)")
# 45 [31, 60]: a figure with its interval
FIGURE = re.compile(r"([+-]?[\d,.]+) \[([+-]?[\d,.]+), ([+-]?[\d,.]+)\]")
WITH_FIGURES = [line for line in TEXT.splitlines() if FIGURE.search(line)]


def shown(number, like):
    """A number as the README would print it: with the decimals, commas and sign of a text."""
    places = len(like.partition(".")[2])
    return f"{number:{'+' if like[0] == '+' else ''},.{places}f}"


@pytest.mark.parametrize("line", WITH_FIGURES, ids=lambda line: line.strip("| ")[:40])
def test_every_figure_is_that_of_its_table(line):
    """The title of a link to a CSV names the cells behind the figure, as stages.charts.cells has them."""
    (texts,) = FIGURE.findall(line)
    ((path, title),) = [link for link in LINK.findall(line) if link[1]]
    where, _, columns = title.partition(": ")
    numbers = [number_of(rows_of(ROOT / path, where), column) for column in columns.split()]
    assert list(texts) == [shown(number, text) for number, text in zip(numbers, texts, strict=True)]


def test_the_minutes_of_a_run_are_those_that_the_benchmark_took():
    [minutes] = re.findall(r"(\d+) minutes of one core, (\d+) of two", TEXT)
    metrics = ("processor time", "wall time")
    rows = [rows_of(ROOT / "reports/bench/pipeline.csv", f"what=all stages metric={name}") for name in metrics]
    assert [float(text) for text in minutes] == pytest.approx([number_of(row, "value") / 60 for row in rows], abs=0.5)


COUNTED = re.compile(r"(\d+) (?:meshes|point clouds|random sets)")
COUNTS = [line for line in WITH_FIGURES if COUNTED.search(line) and "claims.csv" in line]


@pytest.mark.parametrize("line", COUNTS, ids=lambda line: line.strip("| ")[:40])
def test_the_objects_that_a_claim_was_tested_on_are_as_many_as_its_units(line):
    ((path, title),) = [link for link in LINK.findall(line) if link[1]]
    units = number_of(rows_of(ROOT / path, title.partition(": ")[0]), "units")
    assert sum(map(int, COUNTED.findall(line))) == units


PAGES = "../../deployments/github-pages"  # on GitHub, from any fork: the site that pages.yml publishes


def test_every_link_leads_to_a_file_or_to_the_published_site():
    links = [path for path, _ in LINK.findall(TEXT)]
    assert PAGES in links and not [path for path in links if path != PAGES and not (ROOT / path).exists()]


def test_every_command_is_there():
    code = "\n".join(text for _, text in CODE.findall(TEXT))
    modules = set(re.findall(r"python -m stages\.([\w.]+)", TEXT))
    assert modules and all(find_spec(f"stages.{name}") for name in modules)
    assert set(re.findall(r"haptic-glance (\w+)", code)) <= {*MESH_COMMANDS}
    made = set(re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(), re.M))
    assert {"repro", "test"} <= set(re.findall(r"^make (\w+)", code, re.M)) <= made
    options = re.findall(r"\b(experiment|profile|parallel|classifier)=([\w,]+)", TEXT)
    assert options and all(set(names.split(",")) <= set(groups()[group]) for group, names in options)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:assuming")
def test_the_python_example_runs(tmp_path, monkeypatch):
    ball = trimesh.creation.icosphere(subdivisions=4)
    ball.vertices *= [40.0, 28.0, 20.0]
    ball.vertices[:, 2] += 0.005 * ball.vertices[:, 0] ** 2
    ball.export(tmp_path / "scan.stl")
    code, _ = [code for language, code in CODE.findall(TEXT) if language == "python"]
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(code, names)
    assert names["values"].shape == (2562,) and len(names["points"])
    assert len(names["small"].faces) <= 1500 and names["image"].shape == (16, 16)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*up")
def test_the_robot_of_the_python_example_knows_what_it_touches(tmp_path, monkeypatch):
    from haptic_glance import Viewpoint, render
    from haptic_glance.know import stand

    _, code = [code for language, code in CODE.findall(TEXT) if language == "python"]
    for name, size in (("mug", (0.1, 0.08, 0.12)), ("jug", (0.16, 0.1, 0.2))):
        trimesh.creation.box(size).export(tmp_path / f"{name}.stl")
    monkeypatch.chdir(tmp_path)
    there = stand("jug.stl", turn=25)

    class Hand:
        def touch(self, origin, direction):
            return names["library"].approach(origin, direction).feel(there)

    small = Mesh(there.vertices / np.linalg.norm((0.16, 0.1, 0.2)), there.faces)
    camera = Viewpoint(0, 35)
    names = {"hand": Hand(), "camera": camera, "picture": render(small, camera, size=(90, 120)).rgb}
    exec(code, names)
    assert names["belief"].known == "jug"
