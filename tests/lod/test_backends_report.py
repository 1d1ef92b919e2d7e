"""The backends of simplify beside each other: paired cells, refusals and growth."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

from stages.charts.results import NotRun
from stages.lod import report as meshes
from stages.lod.backend_report import growth
from stages.report.parts import build_item

SIZES = [2000, 20_000, 50_000, 100_000, 400_000, 1_000_000]
LEVELS = {0.5: 1.0, 0.1: 2.0}  # seconds of a share, beside the other's


def benched(power=1.0, noise=0.0):
    """Rows of three backends: `fast` takes a twentieth of the time at nine tenths of the error; large: one share."""
    rows, random = [], np.random.default_rng(0)
    for k, full in enumerate(SIZES):
        for share in (0.5, 0.1) if full <= 100_000 else (0.1,):
            base = LEVELS[share] * 1e-6 * (full * np.log(full)) ** power
            for backend, time, error in (("pymeshlab", 1, 1), ("fast", 0.05, 0.9), ("poor", 0.5, 1.5)):
                for points in (0, 12):
                    cell = {"mesh": f"m{k}", "source": "psb", "share": share, "full": full, "rings": 3}
                    cell |= {"target": int(share * full), "kept_points": points, "backend": backend}
                    cell |= {"outcome": "reached", "seconds": base * time * np.exp(noise * random.normal())}
                    cell |= {"metro_mean": 1e-3 * error, "ssim_error": 0.01 * error, "ratio": time}
                    cell |= {"whole_ratio": 2 * time, "colours_ratio": 3 * time, "error_ratio": error}
                    cell |= {"largest_ratio": 1.1 * error}
                    rows.append(cell | {"kept": True, "valid": True, "note": ""})
    return pd.DataFrame(rows)


@pytest.fixture
def bench(measure):
    return partial(measure, "bench/simplification")


table = partial(build_item, meshes, "tables", "backends")


def by_backend(results):
    return table(results).frame.set_index(["backend", "with_points"])


@pytest.mark.slow
def test_backends_are_compared_as_ratios_and_their_growth_without_and_with_points_apart(bench):
    rows = benched()
    rows.loc[(rows["backend"] == "poor") & (rows["mesh"] == "m4"), "kept"] = False
    kept = rows["kept_points"] > 0
    rows.loc[kept, "seconds"] *= rows.loc[kept, "full"] * np.log(rows.loc[kept, "full"])
    frame = by_backend(bench(rows))
    row = frame.loc["fast", True]
    assert (row["time_ratio"], row["error_ratio"], row["seen_ratio"]) == pytest.approx((0.05, 0.9, 0.9))
    assert (row["whole_ratio"], row["colours_ratio"]) == pytest.approx((0.1, 0.15))
    assert row["kept"] == 1 and row["valid"] == 1 and np.isnan(frame.loc[("fast", False), "kept"])
    assert frame.loc[("poor", True), "kept"] == pytest.approx(9 / 10)
    assert frame.loc[("fast", False), "loglinear_power"] == pytest.approx(1)
    assert frame.loc[("fast", True), "loglinear_power"] == pytest.approx(2)


@pytest.mark.parametrize(("outcome", "points"), [("refused", 12), ("missed", 0)])
@pytest.mark.slow
def test_a_refusal_or_a_miss_is_counted_and_takes_its_cell_from_all(bench, outcome, points):
    rows = benched()
    cell = (rows["mesh"] == "m1") & (rows["kept_points"] == points) & (rows["share"] == 0.1)
    rows.loc[cell, "ratio"] *= 100  # a cell that would change every mean
    failed = cell & (rows["backend"] == "poor")
    if outcome == "refused":
        rows.loc[failed, ["seconds", "ratio", "error_ratio", "metro_mean", "ssim_error"]] = np.nan
    rows.loc[failed, "outcome"] = outcome
    built = table(bench(rows))
    frame = built.frame.set_index(["backend", "with_points"])
    assert frame.loc[("poor", points > 0), ["tried", outcome, "cells"]].tolist() == [10, 1, 9]
    assert frame.loc[("fast", points > 0), ["tried", "refused", "missed", "cells"]].tolist() == [10, 0, 0, 9]
    assert frame["refused"].sum() + frame["missed"].sum() == 1
    assert frame.loc[("fast", points > 0), "time_ratio"] == pytest.approx(0.05)
    assert frame.loc[("fast", points == 0), "cells"] == 10
    assert sorted(built.shown["missed"].unique()) == ["0 of 10", "1 of 10"][: 1 + (outcome == "missed")]


@pytest.mark.slow
def test_infeasible_targets_are_no_refusals_and_a_backend_that_keeps_nothing_takes_no_cell_from_the_others(bench):
    rows = benched()
    rows.loc[rows["mesh"] == "m0", "outcome"] = "infeasible"
    built = table(bench(rows[(rows["backend"] != "poor") | (rows["kept_points"] == 0)]))
    assert (built.frame["refused"] == 0).all() and (built.frame["tried"] == 8).all()
    assert "4 infeasible targets" in built.notes[0]
    frame = built.frame.set_index(["backend", "with_points"])
    assert frame.loc[("fast", True), "cells"] == 8 and ("poor", True) not in frame.index


@pytest.mark.parametrize("power", [0.8, 1.4])
def test_growth_finds_the_power_though_large_meshes_have_one_share(power):
    rows = benched(power).assign(with_points=False)
    fitted, low, high = growth(rows[rows["backend"] == "fast"])
    assert fitted == pytest.approx(power, abs=1e-9) and low <= fitted <= high
    plain, *_ = growth(rows[rows["backend"] == "fast"], "linear")
    assert plain == pytest.approx(power * (1 + 1 / np.log(100_000)), rel=0.02)  # n log n, seen as a power of n


def test_growth_needs_large_meshes():
    rows = benched().assign(with_points=False)
    assert np.isnan(growth(rows[rows["full"] <= 20_000])).all()


def test_rows_without_outcomes_are_not_run(bench):
    with pytest.raises(NotRun, match="make bench"):
        table(bench(benched().drop(columns="outcome")))
