"""Tables and figures of salient points, on rows with a known truth."""

import shutil
from functools import partial

import numpy as np
import pytest

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.look.views import TWELVE
from stages.charts.results import NotRun
from stages.report.parts import build_item
from stages.salient_points import report
from stages.salient_points.report import agreement, difference, rivals

table_of = partial(build_item, report, "tables")
figure_of = partial(build_item, report, "figures")


@pytest.fixture
def root(seen, tmp_path):
    """A copy of the root of that run."""
    return shutil.copytree(seen.workspace.root, tmp_path / "root")


@pytest.fixture
def marked(measure):
    """A function of rows of salient points, of gaze or another set, to the results."""
    return lambda rows, dataset="gaze": measure("salient_points", rows, dataset)


def test_gain_is_paired_so_that_hard_meshes_do_not_widen_it(seen):
    frame = agreement(seen.rows("salient_points", "gaze"), ["nss"]).set_index("method")
    row = frame.loc["itti"]
    assert row["gain"] == pytest.approx(1.3, abs=0.02)
    assert row["gain_high"] - row["gain_low"] < 0.1 < row["high"] - row["low"]


def test_methods_that_have_seen_the_object_are_no_rivals(seen):
    assert rivals(seen.rows("salient_points", "gaze"), "nss")[0] == "facing_viewer"
    with pytest.raises(NotRun, match="sift"):
        difference(seen.rows("salient_points", "gaze"), "nss", "glance", "sift")


def test_marks_of_another_set_are_no_model_s_and_marks_need_ground_truth(marked, small):
    rows = small.judged()
    assert "vision model" not in "".join(table_of("attention_marks", marked(rows, "furniture")).notes)
    with pytest.raises(NotRun, match="ground truth"):
        table_of("attention_marks", marked(rows[rows["metric"] == "points_strong"], "household"))


def test_object_without_ground_truth_is_passed_over(root, small):
    seen = small.read_results(root)
    (root / "data/test/weights/ground_truth/ball.npz").unlink()
    assert report.objects_with_truth(seen, ["ball"], 2) == ["cube"]
    (root / "data/test/weights/ground_truth/cube.npz").unlink()
    with pytest.raises(NotRun, match="ground truth"):
        figure_of("figure_3_12", seen)


@pytest.mark.slow
def test_maps_without_a_channel_are_not_run_but_no_crash(root, small):
    for path in (root / "data/test/conspicuity").glob("*.npz"):
        stored = read_arrays(path)
        write_arrays(path, **stored | {"channels": stored["channels"][:3], "maps": stored["maps"][:, :3]})
    seen = small.read_results(root)
    for name in ("figure_3_3", "figure_3_13"):
        with pytest.raises(NotRun, match="dkl"):
            figure_of(name, seen)
    assert figure_of("figure_3_10", seen).paths[0].exists()


def test_a_view_that_shows_a_sheet_from_its_edge_is_not_drawn():
    masks = np.zeros((12, 4, 4), dtype=bool)
    masks[[3, 7], 1, 1] = True
    assert report._nearest(TWELVE, masks, range(12)) in (3, 7)
