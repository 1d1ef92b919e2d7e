"""The score of a method, its breaking points with censored ends, and pairs, on rows with a known truth."""

import numpy as np
import pandas as pd
import pytest

from stages.engine.statistics import breaking_interval
from stages.report import stability
from stages.report.results import NotRun
from stages.report.stability.breaking import cell
from stages.report.stability.people import compared, verdict
from stages.report.stability.score import corruption_errors, of_gaze, of_points, points_lost, scores
from stages.report.topics import build_one
from stages.stability.simplification import breaking_points

from .test_stability_report import results

NOISE, TILT, LIGHT = [0.001, 0.005], [15.0, 90.0], [60.0]
LOST = {  # of each method under noise, tilt and light, the mean over the objects
    "itti": (0.4, 0.8, 0.5), "harris": (0.2, 0.0, 0.0), "glance": (0.2, 0.4, 0.25), "random": (1.0, 1.0, 1.0),
}  # fmt: skip
CHANCE = 0.1


def row(item, method, perturbation, severity, metric, value):
    return {"item": item, "method": method, "perturbation": perturbation, "severity": severity, "metric": metric,
            "value": value, "seconds": 1.0, "note": None}  # fmt: skip


def rows(objects=12, lost=None, spread=0.3):
    """Rows whose lost share varies over the objects by `spread` of itself, alike for all methods."""
    entries = []
    for number in range(objects):
        more = 1 + spread * (2 * number / max(objects - 1, 1) - 1)
        for method, shares in (lost or LOST).items():
            cases = zip(("noise", "tilt", "light"), (NOISE, TILT, LIGHT), shares, strict=True)
            for name, severities, share in cases:
                for severity in severities:
                    again = 1 - share * (1 if method == "random" else more) * (1 - CHANCE)
                    where = (f"object {number}", method, name, severity)
                    entries += [row(*where, "repeatability", again), row(*where, "chance", CHANCE)]
    return entries


def scored(entries, **options):
    return scores(of_points(pd.DataFrame(entries)), **options).set_index("method")


def test_the_reference_is_one_chance_scores_as_chance_and_others_are_measured_by_it():
    frame = scored(rows())
    assert frame.loc["itti", ["mce", "mce_low", "mce_high", "relative"]].tolist() == [1, 1, 1, 1]
    assert frame["mce"]["glance"] == pytest.approx(0.5) and frame["mce"]["harris"] == pytest.approx(0.5 / 3)
    assert frame.loc["harris", ["surface", "pose", "picture"]].tolist() == pytest.approx([0.5, 0, 0])
    assert frame["mce"]["random"] == pytest.approx(np.mean([1 / 0.4, 1 / 0.8, 1 / 0.5]))
    assert frame["found"]["random"] == pytest.approx(0) and frame["found"]["harris"] == pytest.approx(1 - 0.2 / 3)
    assert scored(rows(), reference="glance")["mce"]["itti"] == pytest.approx(2)
    # Hendrycks and Dietterich sum first: no division by zero for a shape on which the reference loses nothing.
    assert scored(rows(spread=1.0))["mce"]["glance"] == pytest.approx(0.5)
    assert scored(rows(objects=1))["mce_low"].isna().all()
    with pytest.raises(NotRun, match="itti, the reference of the score"):
        scored(rows(lost={"harris": (0.1, 0.1, 0.1)}))


def test_the_score_is_paired_over_the_objects():
    """Where all methods lose more on the same objects, their ratio stays; the share found again does not."""
    frame = scored(rows(spread=0.5))
    assert frame["mce_high"]["glance"] - frame["mce_low"]["glance"] < 1e-9
    assert frame["found_high"]["glance"] - frame["found_low"]["glance"] > 0.05
    table = pd.DataFrame(rows(spread=0.0))
    some = table["item"].isin(["object 1", "object 5"]) & (table["metric"] == "repeatability")
    table.loc[some & (table["method"] == "glance"), "value"] = 0.2
    known = scores(of_points(table)).set_index("method").loc["glance"]
    assert known["mce_low"] < known["mce"] - 0.1 and known["mce_high"] > known["mce"] + 0.1


def test_severities_are_summed_before_the_ratio():
    table = pd.DataFrame(rows(objects=4, spread=0))
    mild = (table["perturbation"] == "tilt") & (table["severity"] == 15.0) & (table["metric"] == "repeatability")
    table.loc[mild & (table["method"] == "itti"), "value"] = 1.0  # now 0 and 0.8, beside 0.4 and 0.4
    errors = of_points(table)
    ratio, names = corruption_errors(errors, "itti", np.ones((1, 4)))
    assert ratio[0, errors.methods.index("glance"), names.index("tilt")] == pytest.approx(1.0)


def test_what_costs_the_reference_nothing_is_left_out_and_named(tmp_path):
    lost = LOST | {"itti": (0.4, 0.8, 0.0)}
    frame = scored(rows(lost=lost))
    assert frame["mce"]["glance"] == pytest.approx(0.5) and frame["picture"].isna().all()
    built = build_one(stability, "tables", "stability_score", results(tmp_path, rows(lost=lost)))
    assert "Without light" in " ".join(built.notes)
    assert built.summary.startswith("The most stable method, 3D-Harris, loses 25 [")


def test_a_disturbance_that_failed_on_a_shape_counts_for_no_method():
    table = pd.DataFrame(rows())
    failed = (table["item"] == "object 3") & (table["perturbation"] == "tilt")
    table.loc[failed, "value"] = np.nan
    assert scores(of_points(table)).set_index("method")["mce"]["glance"] == pytest.approx(0.5)


def test_copies_of_a_shape_count_once():
    table = pd.DataFrame(rows(objects=4)).replace({"object 2": "cubesmall", "object 3": "cubelarge"})
    errors = of_points(table)
    assert errors.objects == ["cube", "object 0", "object 1"]
    whole = of_points(pd.DataFrame(rows(objects=4))).values
    assert np.allclose(errors.values, [whole[2:].mean(axis=0), whole[0], whole[1]])
    curves = breaking_points(table[table["method"] == "itti"])["tilt", "itti"]
    keys = ["item", "method", "perturbation", "severity", "metric"]
    three = table.replace({"cubelarge": "cubesmall"}).groupby(keys, as_index=False, sort=False)["value"].mean()
    assert curves == pytest.approx(breaking_points(three[three["method"] == "itti"])["tilt", "itti"])


def test_relative_errors_are_those_beyond_the_undisturbed():
    """A method that is bad from the start and loses nothing more is as good as none: Hendrycks' relative mCE."""
    entries = []
    for item in ("a", "b", "c"):
        for method, start, after in (("itti", 0.7, 0.5), ("glance", 0.9, 0.8), ("harris", 0.5, 0.5)):
            entries.append(row(item, method, "none", np.nan, "auc", start))
            entries += [row(item, method, "noise", severity, "auc", after) for severity in NOISE]
    known = scores(of_gaze(pd.DataFrame(entries))).set_index("method")
    assert known["mce"].to_dict() == pytest.approx({"itti": 1.0, "glance": 0.4, "harris": 1.0})
    assert known["relative"].to_dict() == pytest.approx({"itti": 1.0, "glance": 0.5, "harris": 0.0})


@pytest.mark.parametrize("unharmed", [0.0, 1.0])
def test_an_interval_is_censored_where_resamples_do_not_break(unharmed):
    """Rising and falling severities; ends go from mild to harsh."""
    severities = [0.5, 0.9] if unharmed == 0 else [0.5, 0.1]
    all_break, none_breaks = np.tile([0.9, 0.1], (20, 1)), np.tile([0.9, 0.8], (20, 1))
    at, low, high = breaking_interval(severities, all_break, unharmed)
    assert [at, low, high] == pytest.approx(3 * [0.7 if unharmed == 0 else 0.3])
    assert np.isnan(breaking_interval(severities, none_breaks, unharmed)).all()
    mixed = np.vstack([np.tile([0.9, 0.1], (11, 1)), np.tile([0.9, 0.8], (9, 1))])  # their mean is 0.415
    at, low, high = breaking_interval(severities, mixed, unharmed)
    assert np.isfinite([at, low]).all() and np.isnan(high)
    assert abs(low - unharmed) < abs(at - unharmed)  # the mild end is nearer to what changes nothing
    mostly = np.vstack([np.tile([0.9, 0.1], (8, 1)), np.tile([0.9, 0.8], (12, 1))])  # their mean is 0.52
    at, low, high = breaking_interval(severities, mostly, unharmed)
    assert np.isnan([at, high]).all() and np.isfinite(low)


def test_the_text_of_a_censored_breaking_point():
    def text(at, low, high, unharmed=0.0):
        values = {"breaking_point": at, "low": low, "high": high, "harshest": 0.3}
        return cell(pd.DataFrame([values]).iloc[0], unharmed)

    assert text(np.nan, np.nan, np.nan) == "> 0.3" and text(np.nan, np.nan, np.nan, 1.0) == "< 0.3"
    assert text(0.2, 0.1, np.nan) == "0.20 [0.10, > 0.3]" and text(np.nan, 0.1, np.nan) == "> 0.3 [0.10, > 0.3]"
    assert text(0.2, 0.2, 0.2) == "0.20"


def pairs(both, first=0.2, second=0.3, objects=10):
    """Rows of two disturbances and of both, with a small spread over the objects."""
    entries = []
    for number in range(objects):
        shares = (("noise", 0.001, first), ("noise", 0.005, 0.9), ("tilt", 15.0, second), ("noise+tilt", None, both))
        for name, severity, share in shares:
            moved = share + (0.01 * (number % 3 - 1) if name == "noise+tilt" else 0)
            where = (f"object {number}", "glance", name, severity)
            entries += [row(*where, "repeatability", 1 - moved * (1 - CHANCE)), row(*where, "chance", CHANCE)]
    return entries


@pytest.mark.parametrize(("both", "word"), [(0.5, "additive"), (0.35, "milder"), (0.7, "worse")])
def test_a_pair_is_compared_with_the_sum_of_its_parts(tmp_path, both, word):
    built = build_one(stability, "tables", "stability_pairs", results(tmp_path, pairs(both)))
    line = built.shown.iloc[0]
    assert line["is"] == word and line["disturbances"] == "noise and tilt"
    assert [line[f"{part}, %"] for part in ("first alone", "second alone", "both")] == ["20", "30", f"{100 * both:.0f}"]
    assert f"1 {word}" in " ".join(built.notes)
    assert built.summary.startswith("The pair of disturbances that costs our glance most is noise and tilt: ")


def test_the_sum_of_a_pair_is_all_at_most_and_independent_losses_are_milder():
    lost = points_lost(pd.DataFrame(pairs(1.0, 0.8, 0.7)))
    losses = compared(lost, "noise+tilt", {"noise": 0.001, "tilt": 15.0})
    assert losses["beyond"] == pytest.approx(0, abs=0.01) and losses["independent"] == pytest.approx(0.06, abs=0.01)
    assert verdict(np.nan, np.nan) == "additive"


def used(method="glance", scale=1.0, objects=8):
    """Points of the glance halve the salient error of plain simplification, disturbed ones save a tenth."""
    entries = []
    for number in range(objects):
        size = 0.01 * scale * (1 + number)
        for name, severity, error, known in (
            ("plain", None, 1.0, None),
            ("none", None, 0.5, 0.9),
            ("noise", 0.001, 0.9, 0.6),
        ):
            where = (f"object {number}", method, name, severity)
            entries.append(row(*where, "lod_salient", error * size * (1 + 0.01 * (number % 2))))
            if known:
                entries.append(row(*where, "recognised", known + 0.01 * (number % 3 - 1)))
    return entries
