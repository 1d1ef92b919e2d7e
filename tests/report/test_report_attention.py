"""What the report says of where people look: tables, figures, charts and claims, on rows with a known truth."""

import re
import shutil
from functools import partial

import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.look.views import TWELVE
from stages.charts.datasets import COLOURED
from stages.charts.pareto import attention_seconds
from stages.charts.results import NotRun
from stages.engine.statistics import interval
from stages.report.page import pack_viewer
from stages.report.parts import build_item
from stages.salient_points import report as attention
from tests.report.frames import only


@pytest.fixture(scope="module")
def seen(tmp_path_factory, small):
    """The results of the small run with everything about attention; tests that change it take `root`."""
    root = small.root(tmp_path_factory.mktemp("seen"))
    small.write_attention(root)
    return small.results(root)


table_of = partial(build_item, attention, "tables")
figure_of = partial(build_item, attention, "figures")


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


def test_sentences_follow_from_the_numbers(marked, small):
    notes = " ".join(table_of("attention_gaze", marked(small.judged({"glance": 0.25}))).notes)
    assert "In NSS ours is higher than 3 of the 7 others" in notes
    assert "not than facing viewer" in notes
    for pair, word in (
        ("guided by ED − thesis, nine equal weights", "higher"),
        ("guided by SSIM − thesis, nine equal weights", "lower"),
        ("thesis, equal weights − Itti's attention", "not told apart"),
    ):  # fmt: skip
        assert re.search(rf"{pair}: NSS [-+.\d]+ \[[-., \d]+\] \({word}\)", notes)


def test_table_of_gaze_stands_without_our_method_or_the_ceiling(marked, small):
    rows = small.judged()
    table = table_of("attention_gaze", marked(rows[~rows["method"].isin(["glance", "human"])]))
    assert table.frame["method"].iloc[0] == "svm+object"
    assert (table.shown["ours − it, NSS"] == "–").all()


def test_marks_of_another_set_are_no_model_s_and_marks_need_ground_truth(marked, small):
    rows = small.judged()
    assert "vision model" not in "".join(table_of("attention_marks", marked(rows, "furniture")).notes)
    with pytest.raises(NotRun, match="ground truth"):
        table_of("attention_marks", marked(rows[rows["metric"] == "points_strong"], "household"))


def test_intervals_of_learned_weights_are_those_of_the_objects(seen, small):
    _, values = small.learned_weights()
    row = only(table_of("table_3_1", seen).frame, dataset="gaze", method="guided_ssim", channel="color")
    assert row[["mean", "low", "high"]].tolist() == pytest.approx(interval(values[:, 0]), abs=1e-5)


def test_what_hues_change_stands_beside_the_weights_and_a_flat_map_has_none(seen, measure):
    row = {"item": "a", "method": "dkl", "metric": "grey_likeness", "value": 0.4}
    rows = [row, row | {"item": "b", "value": 0.6}, row | {"method": "color", "value": None}]
    results = measure("weights", seen.rows("weights", "gaze"), "gaze")
    results = measure("conspicuity", pd.DataFrame(rows), COLOURED, results)
    shown = table_of("table_3_1", results).shown.set_index("channel")["in colour: r with itself in grey"]
    assert shown["DKL"].startswith("0.50 [") and shown["color"] == "–"


def test_object_without_ground_truth_is_passed_over(root, small):
    seen = small.results(root)
    (root / "data/test/weights/ground_truth/ball.npz").unlink()
    assert seen.with_ground_truth(["ball"], 2) == ["cube"]
    (root / "data/test/weights/ground_truth/cube.npz").unlink()
    with pytest.raises(NotRun, match="ground truth"):
        figure_of("figure_3_12", seen)


@pytest.mark.slow
def test_maps_without_a_channel_are_not_run_but_no_crash(root, small):
    for path in (root / "data/test/conspicuity").glob("*.npz"):
        stored = read_arrays(path)
        write_arrays(path, **stored | {"channels": stored["channels"][:3], "maps": stored["maps"][:, :3]})
    seen = small.results(root)
    for name in ("figure_3_3", "figure_3_13"):
        with pytest.raises(NotRun, match="dkl"):
            figure_of(name, seen)
    assert "color, contrast, curvature" in figure_of("figure_3_10", seen).alt


def test_cost_counts_views_channels_and_points(seen):
    cost = attention_seconds(seen, "gaze")
    assert cost["itti"] == pytest.approx(2 + 3 + 0.5)
    assert cost["facing_viewer"] == pytest.approx(0.5)


VERDICTS = {
    "glance_over_best_gaze": "supported", "guided_ed_gaze": "supported", "guided_ssim_gaze": "contradicted",
    "equal_over_itti_gaze": "no difference", "svm_per_object": "supported", "svm_per_object_unseen": "open",
}  # fmt: skip


SHAPE_CLAIMS = ["symmetry_gain_varies", "symmetry_gain_extremes", "gain_by_convexity"]


def gains_of(objects, symmetry, others, shapes):
    """Rows of information gains: of symmetry (objects,), of three other channels (objects, 3), and of shapes."""
    rows = []
    for k in range(objects):
        values = {
            "symmetry": symmetry[k],
            **dict(zip(("edge", "dkl", "entropy"), others[k], strict=True)),
            "color": 0.0,
        }
        shared = {"item": f"object {k:02d}", "metric": "information_gain", "area": "image"}
        rows += [shared | {"channel": channel, "value": value} for channel, value in values.items()]
        rows += [{"item": f"object {k:02d}", "metric": metric, "value": values[k]} for metric, values in shapes.items()]
    return pd.DataFrame(rows)


def test_page_offers_few_methods_and_any_where_none_of_those_ran(seen, root, small):
    assert list(pack_viewer(seen)["objects"][0]["saliency"]) == ["glance", "itti"]
    for path in (root / "data/test/salient_points").glob("*.npz"):
        write_arrays(path, **{key: values for key, values in read_arrays(path).items() if key.startswith("height")})
    assert list(pack_viewer(small.results(root))["objects"][0]["saliency"]) == ["height"]


def nested_rows():
    """The glance on six objects: nesting costs it a tenth of NSS each."""
    rows = []
    for way, k in product(("once", "nested"), range(6)):
        lost = 0.1 * (1 + 0.01 * k) if way == "nested" else 0.0
        numbers = {"nss": 1.5 + 0.1 * k - lost, "auc": 0.8 + 0.01 * k, "ridge": 0.03}
        numbers["features"] = 3 if way == "once" else 1 + k % 2
        names = ["rank", "seen", "detail"][: int(numbers["features"])]
        common = {"dataset": "gaze", "method": f"glance_{way}", "item": f"o{k}", "chosen": ", ".join(names)}
        rows += [common | {"metric": metric, "value": value} for metric, value in numbers.items()]
    return rows


def test_a_view_that_shows_a_sheet_from_its_edge_is_not_drawn():
    masks = np.zeros((12, 4, 4), dtype=bool)
    masks[[3, 7], 1, 1] = True
    assert maps._nearest(TWELVE, masks, range(12)) in (3, 7)
