"""What the report makes of the stage."""

import pytest

from haptic_glance.base.files import write_text
from stages.charts.drawing import label
from stages.charts.results import Results
from stages.engine.rows import write_rows
from stages.engine.settings import Workspace
from stages.report import Params
from stages.report.parts import build_item
from stages.stability import COLUMNS
from stages.stability import report as stability

SETTINGS = Params(
    hero_object="pear", figure_objects=["pear"], viewer_objects=[], viewer_count=0, viewer_faces=0,
    viewer_lod_methods=[], viewer_kilobytes=0,
)  # fmt: skip


def results(root, rows):
    """The Results of a root with the rows of a set `test`, or without any."""
    write_text(root / "params.yaml", "sets: [test]\ngraph: {}\ntest: {}")
    workspace = Workspace(root, "test")
    if rows:
        write_rows(workspace.measurements / "stability.csv.gz", rows, COLUMNS, "test", 0)
    return Results(workspace.on(""), SETTINGS)


@pytest.mark.slow
def test_report_shows_what_breaks_a_method_and_a_chart_of_it(disturbed):
    measured = results(disturbed.root, disturbed.rows)
    built = build_item(stability, "tables", "stability", measured)
    shown = built.shown.set_index("perturbation")
    assert shown.loc["vertex order", label("harris")] == "> 1" and float(shown.loc["noise", label("harris")]) < 0.02
    assert label("random") not in shown and any("no surface" in note for note in built.notes)
    figure = build_item(stability, "figures", "stability", measured)
    assert figure.paths[0].stat().st_size > 5000
