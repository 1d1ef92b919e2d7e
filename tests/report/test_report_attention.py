"""What the report says of where people look: tables, figures, charts and claims, on rows with a known truth."""

import re
import shutil
from functools import partial

import numpy as np
import pandas as pd
import pytest
from scipy import stats
from stages.report.attention import maps

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.look.views import TWELVE
from stages.charts.datasets import COLOURED
from stages.charts.pareto import attention_seconds
from stages.charts.results import NotRun
from stages.engine.statistics import interval
from stages.report import attention
from stages.report.page import pack_viewer
from stages.report.parts import CLAIMS, build_item
from stages.salient_points.agreement_tables import agreement, difference, rivals
from tests.report.frames import only, verdicts


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
    assert table.frame["method"].iloc[0] == "svm_object"
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


def test_claims_on_gaze_follow_from_the_rows(root, small):
    measured = root / "reports/measurements"
    (measured / "gaze_3_2").mkdir()
    shutil.copy(measured / "gaze/weights.csv.gz", measured / "gaze_3_2")  # whose weights were learned as printed
    judged = verdicts(CLAIMS, small.results(root), *VERDICTS)
    assert judged["verdict"].to_dict() == VERDICTS
    assert judged.loc["svm_per_object", "effect"] == pytest.approx(4)  # in the thesis's way
    assert judged.loc["svm_per_object_unseen", "tested_on"].startswith("not run")  # no whole object left out


@pytest.mark.parametrize(("entropy", "word"), [(1.0, "supported"), (-1.0, "contradicted")])
def test_the_largest_and_the_least_weight_are_held_against_the_next_channel_by_object(measure, small, entropy, word):
    frame, values = small.learned_weights(entropy=entropy, color=-entropy)
    rows = frame.rename(columns={"weight": "value", "left_out": "item"}).assign(metric="weight")
    judged = verdicts(CLAIMS, measure("weights", rows, "gaze_3_2"), "entropy_most_ssim", "colour_least_ssim")
    measured = pd.DataFrame(values, columns=frame["channel"].unique()[: values.shape[1]])
    largest = measured.drop(columns="entropy").mean().idxmax()
    least = measured.drop(columns="color").mean().idxmin()
    leads = {
        "entropy_most_ssim": measured["entropy"] - measured[largest],
        "colour_least_ssim": measured[least] - measured["color"],
    }
    for key, lead in leads.items():
        assert judged.loc[key, ["effect", "low", "high"]].tolist() == pytest.approx(interval(lead), abs=1e-4)
    assert judged["verdict"].tolist() == [word, word]


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


def test_gains_are_held_against_other_channels_and_against_the_shape_by_object(measure):
    generator = np.random.default_rng(3)
    symmetry, others = generator.uniform(0.1, 1, 12), generator.normal(0.6, 0.05, (12, 3))
    shapes = {"extremes": symmetry + generator.normal(0, 0.2, 12), "convexity": generator.random(12)}
    results = measure("weights", gains_of(12, symmetry, others, shapes), "gaze_3_2")
    judged = verdicts(CLAIMS, results, *SHAPE_CLAIMS)
    lead = 100 * (np.abs(symmetry / symmetry.mean() - 1) - np.abs(others / others.mean(axis=0) - 1).mean(axis=1))
    columns = ["effect", "low", "high"]
    assert judged.loc["symmetry_gain_varies", columns].tolist() == pytest.approx(interval(pd.Series(lead)), abs=1e-3)

    def jackknife(correlation):
        without = [correlation(np.delete(np.arange(12), k)) for k in range(12)]
        return interval(pd.Series(12 * correlation(np.arange(12)) - 11 * np.array(without)))

    def extremes(ids):
        share = symmetry[ids] / (symmetry[ids] + others[ids].sum(axis=1))
        return stats.spearmanr(share, shapes["extremes"][ids])[0]

    def convexity(ids):
        gains = np.column_stack([symmetry, others])[ids]
        gains /= gains.sum(axis=1, keepdims=True)
        pairs = [(i, j) for i in range(len(ids)) for j in range(i)]
        apart = [np.linalg.norm(gains[i] - gains[j]) for i, j in pairs]
        return stats.spearmanr(apart, [abs(np.diff(shapes["convexity"][ids][[i, j]])[0]) for i, j in pairs])[0]

    for key, correlation in (("symmetry_gain_extremes", extremes), ("gain_by_convexity", convexity)):
        assert judged.loc[key, columns].tolist() == pytest.approx(jackknife(correlation), abs=1e-4)
    assert judged["verdict"].tolist()[0] == "supported"


def test_four_objects_are_too_few_for_a_rank_correlation(measure):
    shapes = {"extremes": np.arange(4.0), "convexity": np.arange(4.0)}
    results = measure("weights", gains_of(4, np.arange(4.0), np.ones((4, 3)), shapes), "gaze_3_2")
    judged = verdicts(CLAIMS, results, *SHAPE_CLAIMS[1:])
    assert judged["verdict"].tolist() == ["open"] * 2 and judged["tested_on"].str.contains("fewer than 5 objects").all()


def test_page_offers_few_methods_and_any_where_none_of_those_ran(seen, root, small):
    assert list(pack_viewer(seen)["objects"][0]["saliency"]) == ["glance", "itti"]
    for path in (root / "data/test/salient_points").glob("*.npz"):
        write_arrays(path, **{key: values for key, values in read_arrays(path).items() if key.startswith("height")})
    assert list(pack_viewer(small.results(root))["objects"][0]["saliency"]) == ["height"]


def test_a_view_that_shows_a_sheet_from_its_edge_is_not_drawn():
    masks = np.zeros((12, 4, 4), dtype=bool)
    masks[[3, 7], 1, 1] = True
    assert maps._nearest(TWELVE, masks, range(12)) in (3, 7)
