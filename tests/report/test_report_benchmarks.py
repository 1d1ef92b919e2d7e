"""Benchmarks in the report: rates of imprints with a known truth, and the chart of kernels over commits."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

from stages.charts.results import NotRun
from stages.report import touch
from stages.report.parts import build_item
from stages.report.stability import costs

RATES = {"ours": 4000.0, "trimesh_embree": 2000.0, "depth_picture": 1000.0, "tacto_32x32": 50.0, "tacto_160x120": 20.0}
ERRORS = {"ours": 1e-16, "trimesh_embree": 1e-15, "depth_picture": 2e-3, "tacto_32x32": 1e-3, "tacto_160x120": 2e-4}
NO_TACTO = "not run: no --tacto PYTHON was given"


def benched(ours=4000.0, tacto=True):
    """Rows of three meshes, on the last of which every rate is a tenth higher; ours is four times as fast at 16."""
    rows = []
    for k, faces in enumerate((2000, 10_000, 50_000)):
        for cells in (16, 32):
            for pitch in (0.002, 0.01):
                for method, rate in (RATES | {"ours": ours * (4 if cells == 16 else 1)}).items():
                    run = tacto or method in ("ours", "trimesh_embree")
                    value = rate * (1.1 if k == 2 else 1) if run else np.nan
                    row = {"what": "rate", "mesh": f"m{k}", "source": "psb", "faces": faces, "cells": cells}
                    row |= {"pitch": pitch, "touches": 40, "method": method, "value": value, "seconds": 1 / value}
                    ratio = value / (20 * (1.1 if k == 2 else 1)) if tacto else np.nan
                    rows.append(row | {"ratio": ratio, "note": "" if run else NO_TACTO})
    for shape in ("plane", "sphere"):
        for method, error in ERRORS.items():
            if tacto or method in ("ours", "trimesh_embree"):
                row = {"what": "error", "mesh": shape, "source": "analytic", "faces": 9, "cells": 31, "pitch": 0.01}
                to_mesh = error * (0.5 if shape == "plane" else 1)
                rows.append(row | {"touches": 1, "method": method, "value": 1.0, "to_mesh": to_mesh, "note": ""})
    return pd.DataFrame(rows)


table = partial(build_item, touch, "tables", "imprint_rates")
chart = partial(build_item, touch, "tradeoff", "imprints")


@pytest.fixture
def bench(measure):
    return partial(measure, "bench/imprints")


def test_rates_ratios_and_errors_are_those_of_the_bench(bench):
    frame = table(bench(benched())).frame
    row = frame[(frame["method"] == "ours") & (frame["cells"] == 32)].iloc[0]
    assert row["rate"] == pytest.approx(4000 * 1.1 ** (1 / 3), rel=1e-4) and row["rate_least"] == pytest.approx(4000)
    assert row["rate_low"] < row["rate"] < row["rate_high"] and row["meshes"] == 3
    assert row["ratio"] == pytest.approx(200) and row["error"] == pytest.approx(1e-16)


@pytest.mark.slow
def test_peers_that_did_not_run_are_said_and_leave_the_rest(bench):
    results = bench(benched(tacto=False))
    built = table(results)
    assert any(NO_TACTO in note for note in built.notes) and "TACTO was not run" in built.notes[0]
    assert built.frame.loc[built.frame["method"] == "ours", "rate"].notna().all()
    assert chart(results).paths[0].exists()


def test_half_a_bench_or_one_without_a_rate_is_not_run(bench):
    rows = benched()
    for broken in (rows[rows["what"] == "rate"].drop(columns="to_mesh"), rows.assign(value=np.nan)):
        with pytest.raises(NotRun, match="not whole"):
            table(bench(broken))


def row(commit, hour, kernel, ratio, machine="here"):
    """A row of the history; ratio None for the reference loop."""
    ends = {} if ratio is None else {"low": 0.9 * ratio, "high": 1.1 * ratio, "limit": 1.5 * ratio}
    date = f"2026-11-21T{hour:02}:00:00+00:00"
    return {"commit": commit, "date": date, "what": kernel, "peer": f"peer of {kernel}", "ratio": ratio, **ends,
            "machine": machine}  # fmt: skip


def test_lines_are_those_of_the_machine_that_measured_last_by_date(measure, monkeypatch):
    drawn, draw = {}, costs._draw

    def noted(axes, rows, *looks):
        drawn[rows["what"].iloc[0]] = rows
        draw(axes, rows, *looks)

    monkeypatch.setattr(costs, "_draw", noted)
    rows = [row("b", 2, "maps", 0.2), row("a", 1, "maps", 0.1), row("a", 1, "old", 5.0, "elsewhere")]
    rows.append(row("b", 2, "loop", None))
    words = costs.kernels(measure("bench/history", pd.DataFrame(rows))).words
    assert list(drawn) == ["maps"] and list(drawn["maps"]["ratio"]) == [0.1, 0.2]
    assert list(drawn["maps"]["place"]) == [0, 1]
    assert words == {"kernels": 1, "commits": 2, "machine": "here", "names": "maps (peer of maps)"}
