"""The published report, rebuilt from its committed rows: tables, claims, numbers of charts, and what items are of."""

import math
import re
from itertools import pairwise, zip_longest
from pathlib import Path

import pytest

from haptic_glance.base.files import write_table
from stages.charts import items
from stages.charts.drawing import SETTINGS, plt
from stages.charts.items import MOST_COLUMNS, Table
from stages.charts.results import Results
from stages.engine.measurements import Measurements
from stages.engine.settings import Workspace
from stages.lod import report as meshes
from stages.report import Params, parts
from stages.report.claims import load
from stages.report.parts import KINDS, PARTS, build_part
from stages.report.verdict import judge

ROOT = Path(__file__).parents[2]
REPORTS = ROOT / "reports"
FROM_DATA = {  # items that need what stages leave in data/
    "dataset", "figure_3_3", "figure_3_10", "figure_3_12", "figure_3_13", "figure_3_29", "figure_3_30", "figure_3_34",
    "look_and_touch_story", "scene", "pipeline", "touch_one_mesh", "imprints", "figure_4_15",
}  # fmt: skip
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?")
REMEDY = "where this change is wanted, `dvc repro` writes it anew"


@pytest.fixture(scope="module", autouse=True)
def few_pixels_and_resamples():
    """No pictures, and, unlike in other tests of the report, as many resamples as published."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(items, "save", lambda figure, path, dpi: plt.close(figure) or path)
        patch.setattr(parts, "item_html", lambda item: "")
        yield


@pytest.fixture
def published(tmp_path):
    """The published results as a fresh clone has them, without what stages left in data/."""
    workspace = Workspace(ROOT, "")
    results = Results.published(workspace, workspace.settings(Params))
    results.data, results.out = tmp_path / "data", tmp_path / "out"
    results.data.mkdir()
    (results.data / "reference").symlink_to(ROOT / "data/reference")
    return results


def alike(line, former):
    """Whether two lines are the same but for what another processor may change: last digits, and 1e-17 for 0."""
    if line == former:
        return True
    if NUMBER.split(line) != NUMBER.split(former):
        return False
    numbers = zip(NUMBER.findall(line), NUMBER.findall(former), strict=True)
    return all(math.isclose(float(first), float(second), rel_tol=2e-5, abs_tol=1e-12) for first, second in numbers)


def assert_unchanged(name, text, expected):
    """Fails with the first line that differs from the published one."""
    lines = zip_longest(text.splitlines(), expected.splitlines(), fillvalue="the end")
    for number, (line, former) in enumerate(lines, start=1):
        assert alike(line, former), f"reports/{name}, line {number}: {former!r} has become {line!r}; {REMEDY}"


def assert_items_unchanged(kind, results, topic):
    built = build_part(topic, results, [kind])
    lacking = {name.partition("/")[2] for name in built.not_run}
    assert lacking <= FROM_DATA, f"{built.not_run} is no longer built; {REMEDY}"
    for view in (view for item in built.items if isinstance(item, Table) for view in item.views):
        assert len(view.text.columns) <= MOST_COLUMNS
    for path in (path for item in built.items for path in item.paths if path.suffix in (".csv", ".md")):
        name = path.relative_to(results.out)
        assert (REPORTS / name).exists(), f"reports/{name} is not published; {REMEDY}"
        assert_unchanged(name, path.read_text(), (REPORTS / name).read_text())


@pytest.mark.slow
def test_committed_rows_give_the_published_claims(tmp_path):
    write_table(tmp_path / "claims.csv", judge(load(), Measurements(REPORTS)))
    assert_unchanged("claims.csv", (tmp_path / "claims.csv").read_text(), (REPORTS / "claims.csv").read_text())


@pytest.mark.parametrize(("kind", "dictionary"), KINDS.items())
def test_every_item_of_the_parts_is_published_and_no_other(kind, dictionary):
    names = {name for part in PARTS.values() for name in getattr(part, dictionary)} - {"recognition"}  # of own folders
    assert names == {path.stem for path in (REPORTS / kind).iterdir()}


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("stage", PARTS)
def test_committed_rows_give_the_published_report(published, kind, stage):
    assert_items_unchanged(kind, published, PARTS[stage])


@pytest.mark.slow
@pytest.mark.parametrize("name", ["figure_3_4", "figure_3_5", "figure_3_23"])
def test_numbers_of_axes_side_by_side_do_not_touch(published, name):
    with plt.rc_context(SETTINGS):
        drawing = meshes.FIGURES[name](published).drawing
        drawing.draw_without_rendering()
        for row in {axes.get_subplotspec().rowspan.start for axes in drawing.axes}:
            boxes = []
            for axes in (axes for axes in drawing.axes if axes.get_subplotspec().rowspan.start == row):
                low, high = axes.get_xlim()
                texts = (text for text in axes.get_xticklabels() if text.get_text())
                boxes += [text.get_window_extent() for text in texts if low <= text.get_position()[0] <= high]
            assert len(boxes) > 8
            ends = sorted((box.x0, box.x1) for box in boxes)
            assert all(right < left for (_, right), (left, _) in pairwise(ends)), name
        plt.close(drawing)
