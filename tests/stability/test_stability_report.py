"""What the report makes of the stage."""

import pandas as pd
import pytest

from haptic_glance.base.files import write_text
from stages.engine.rows import write_rows
from stages.engine.settings import Workspace
from stages.report import Params, stability
from stages.report.drawing import label
from stages.report.results import NotRun, Results
from stages.report.stability import simplification
from stages.report.topics import build_one
from stages.stability import COLUMNS

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
def test_report_shows_the_table_and_the_pictures(disturbed):
    measured = results(disturbed.root, disturbed.rows)
    built = build_one(stability, "tables", "stability", measured)
    shown = built.shown.set_index("perturbation")
    assert shown.loc["vertex order", label("harris")] == "> 1" and float(shown.loc["noise", label("harris")]) < 0.02
    assert label("random") not in shown and any("no surface" in note for note in built.notes)
    figures = [build_one(stability, "figures", name, measured) for name in ("stability", "stability_failures")]
    assert all(path.stat().st_size > 5000 for figure in figures for path in figure.paths)
    assert "missing faces" in figures[1].caption and label("harris") in figures[0].alt


@pytest.mark.slow
def test_report_shows_the_simplified_meshes(tmp_path, simplified):
    measured = results(tmp_path, simplified)
    built = build_one(stability, "tables", "stability_simplification", measured)
    shown = built.shown.set_index(["damage", "simplifier"])
    assert shown.loc[("soup", "pymeshlab"), "least"] == "–"  # feasible at no count but the one that a refusal names
    assert int(shown.loc[("sound", "pymeshlab"), "least"]) <= 64 and shown.index[-1][0] == "all"
    counted = shown[["valid", "refused", "ruined", "crash"]].astype(int).xs("pymeshlab", level="simplifier")
    assert counted.drop("all").sum().tolist() == counted.loc["all"].tolist() and counted.loc["sound", "valid"] > 0
    figure = build_one(stability, "figures", "stability_simplification", measured)
    assert figure.paths[0].stat().st_size > 5000 and "ball" in figure.caption


def test_the_least_count_is_the_one_above_which_all_is_valid():
    rows = [("4", 4, "valid"), ("64", 64, "ruined"), ("50%", 500, "valid"), ("90%", 900, "valid")]
    cases = pd.DataFrame(rows, columns=["budget", "severity", "outcome"]).assign(kept="none", soft=None)
    assert simplification.least_valid(cases) == 500


@pytest.mark.parametrize(
    ("kind", "name"),
    [("tables", "stability"), ("tables", "stability_simplification"), ("figures", "stability"),
     ("figures", "stability_failures"), ("figures", "stability_simplification")],
)  # fmt: skip
def test_report_says_which_stage_to_run(tmp_path, kind, name):
    with pytest.raises(NotRun, match="dvc repro stability"):
        build_one(stability, kind, name, results(tmp_path, []))
