"""The record beside each table and figure: what it was made of, and that it agrees with the table of the thesis."""

import gzip
import shutil
import subprocess
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pandas as pd
import pytest

from haptic_glance.base.files import read_json, sha256, write_json, write_text
from haptic_glance.base.timing import WALL, clock
from stages.engine.settings import CODE
from stages.report import records
from stages.report.drawing import plt
from stages.report.items import Built, Figure, Table, as_printed
from stages.report.page import item_html
from stages.report.records import DIGITS, FILE, PROVENANCE_FILE, record_of, write_records
from stages.report.results import NotRun
from stages.report.topics import KINDS

ROOT = Path(__file__).parents[2]
ROWS = pd.read_csv(ROOT / "data/reference/thesis/fidelity.csv").fillna("")
TWINNED = [row for row in ROWS.itertuples() if row.sets and row.twin not in ("", "claims") and row.run != "no data"]
KNOWN = {kind: read_json(path) for kind in KINDS if (path := ROOT / "reports" / kind / FILE).is_file()}


def disagreement(row, known):
    """The disagreement of a row of the table of the thesis with the record of its twin; empty text for none."""
    twin_sets = [part["items"][row.twin]["sets"] for part in known.values() if row.twin in part["items"]]
    if not twin_sets:
        return f"{row.twin} has no record"
    if any(row.sets in sets for sets in twin_sets):
        return ""
    return f"{row.thesis}: the row says {row.sets}, {row.twin} shows {', '.join(dict.fromkeys(sum(twin_sets, [])))}"


def test_the_row_of_the_thesis_names_a_set_that_its_twin_shows():
    assert TWINNED and [text for row in TWINNED if (text := disagreement(row, KNOWN))] == []


@pytest.mark.parametrize("kind", KINDS)
def test_each_published_file_has_a_record(kind):
    written = {path.stem for path in (ROOT / "reports" / kind).iterdir() if path.name != FILE}
    assert written == set(KNOWN[kind]["items"])


def test_the_provenance_is_that_of_the_rows_that_are_committed():
    provenance = read_json(ROOT / "reports" / PROVENANCE_FILE)
    items = [entry for known in KNOWN.values() for entry in known["items"].values()]
    assert provenance["files"].keys() == {name for entry in items for name in entry.get("files", ())}
    assert {"python", "numpy", "dvc", "torch"} <= provenance["packages"].keys()
    for name, known in provenance["files"].items():
        dataset, _, stage = name.partition("/")
        folder = ROOT / "reports" / ("" if dataset == "bench" else "measurements") / dataset
        (path,) = (path for path in folder.glob(f"{stage}.csv*") if path.name in (f"{stage}.csv", f"{stage}.csv.gz"))
        assert sha256(path)[:DIGITS] == known["sha256"], f"{name} was changed after the report that shows it"


@pytest.fixture
def rows(measure):
    """A function that writes rows of a stage and gives the results of the run."""

    def written(**columns):
        common = {"dataset": "test", "item": ["ball", "ball", "cube"], "method": ["a", "b", "a"], "metric": "faces"}
        frame = pd.DataFrame(common | {"value": 1.0, "seconds": 0.1, "target": ["25%", "1500", "25%"]} | columns)
        return measure("lod", frame)

    return written


def test_a_record_tells_sets_methods_objects_sizes_and_rows(rows):
    results = rows()
    results.rows("lod", "test", method="a")
    item = Table(pd.DataFrame({"x": [1, 2]}), sets=["test"])
    record = record_of(item, results, "tables")
    assert record == {"sets": ["test"], "files": ["test/lod"], "rows": 2, "objects": 2, "methods": ["a"],
                     "sizes": {"target": ["25%"]}}  # fmt: skip
    assert record_of(Table(pd.DataFrame({"method": ["b"]})), results, "tables")["methods"] == ["b"]


def test_rows_of_another_item_are_forgotten_and_rows_not_found_are_no_source(rows):
    results = rows()
    results.rows("lod", "test")
    results.forget()
    with pytest.raises(NotRun):
        results.rows("lod", "test", method="nobody")
    assert not results.read and not results.sources


def test_the_clock_of_older_rows_is_the_wall(rows):
    assert rows().clock("lod", "test") == WALL
    assert rows(clock=clock()).clock("lod", "test") == clock()
    assert rows(clock=[clock(), None, clock()]).clock("lod", "test") == WALL  # of both kinds
    some = rows(clock=[clock(), None, clock()], seconds=[0.1, None, 0.1])
    assert some.clock("lod", "test") == clock()  # a row without seconds needs no clock


def test_a_figure_of_an_earlier_run_keeps_its_record(rows):
    results = rows()
    (results.reports / "figures").mkdir(parents=True, exist_ok=True)
    kept = '{"items": {"figure_1": {"sets": ["old"], "methods": ["m"]}}}'
    (results.reports / "figures" / FILE).write_text(kept)
    drawing = plt.figure()
    record = record_of(Figure(drawing, name="figure_1", sets=["test"]), results, "figures")
    plt.close(drawing)
    assert record == {"drawn": "in an earlier run", "sets": ["test"], "methods": ["m"]}


@pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed")
def test_a_commit_is_told_only_of_an_unchanged_file_that_git_knows(rows, tmp_path):
    results = rows(clock=clock())
    results.rows("lod", "test")
    path = records.path_of(results, "test/lod")
    item = Table(pd.DataFrame({"x": [1]}), name="table", record=record_of(Table(pd.DataFrame()), results, "tables"))

    def known():
        write_records({"tables": Built([item])}, results, tmp_path / "out")
        return read_json(tmp_path / "out" / PROVENANCE_FILE)["files"]["test/lod"]

    def git(*words):
        who = ("-c", "user.name=a", "-c", "user.email=a@b.c")
        return subprocess.run(
            ["git", "-C", str(results.reports), *who, *words], check=True, capture_output=True, text=True
        )

    assert known() == {"sha256": sha256(path)[:DIGITS], "clock": clock()}  # as in a tarball
    git("init")
    assert "commit" not in known()
    git("add", ".")
    git("commit", "-m", "rows")
    assert known()["commit"] == git("log", "-1", "--format=%h").stdout.strip()
    path.write_bytes(path.read_bytes() + gzip.compress(b""))  # the same rows in other bytes
    assert "commit" not in known()


TODAY = "today"


@pytest.mark.parametrize(
    ("graph", "sha", "known", "made", "older"),
    [
        ({}, "same", "before", "before", True),
        ({}, "same", None, None, False),  # nobody knows
        ({}, "other", "before", TODAY, False),  # measured anew
        ({"lod": ["household"]}, "same", "before", "before", True),  # the run has other sets
        ({"lod": ["test"]}, "same", "before", TODAY, False),  # the run has it
    ],
)
def test_rows_of_earlier_code_are_named_below_their_table(rows, tmp_path, graph, sha, known, made, older):
    results = rows()
    results.workspace.params["graph"] = graph
    results.rows("lod", "test")
    entry = {"sha256": sha256(records.path_of(results, "test/lod"))[:DIGITS] if sha == "same" else sha}
    entry |= {"code": known} if known else {}
    write_json(results.reports / PROVENANCE_FILE, {"packages": {}, "files": {"test/lod": entry}})
    write_text(results.workspace.root / CODE, f"lod: {TODAY}")
    item = Table(pd.DataFrame({"x": [1]}), name="table", sets=["test"], paths=[tmp_path / "tables/table.csv"])
    item.record = record_of(item, results, "tables")
    assert ("test (lod)" in item_html(item)) == ("older" in item.record) == older
    write_records({"tables": Built([item])}, results, tmp_path)
    assert read_json(tmp_path / PROVENANCE_FILE)["files"]["test/lod"].get("code") == made


PROTOCOL = "household_3_1"


def figure_x(results):
    drawing, axes = plt.subplots(figsize=(1, 1))
    axes.plot([0, 1])
    return Figure(drawing, {"set": results.sets[0]})


@pytest.fixture
def at(tmp_path):
    """A function (first set, own_meshes) -> the words of the figure and the bytes of its picture, written there."""

    def written(first, of_folder=False):
        results = SimpleNamespace(sets=[first], own_meshes=of_folder, out=tmp_path, reports=tmp_path, read=set())
        figure = partial(as_printed, figure_x, PROTOCOL)(results)
        figure.name = "figure_x"
        figure.write(tmp_path / "figures")
        assert figure.paths[0].is_file() and PROTOCOL in results.read or figure.drawing.axes
        return figure.words, figure.paths[0].read_bytes()

    return written


def test_the_drawing_of_the_printed_protocol_outlasts_its_data_but_not_in_a_folder_of_ones_own(at):
    assert at("household")[0] == {"set": "household"}  # as long as there is none
    drawn = at(PROTOCOL)
    assert drawn[0] == {"set": PROTOCOL}
    assert at("household") == drawn
    assert at("folder", of_folder=True)[0] == {"set": "folder"}
