"""Table 3.1: the learned weights."""

import pandas as pd
import pytest

from stages.charts.datasets import COLOURED
from stages.engine.statistics import interval
from stages.report.parts import build_item
from stages.weights import report
from tests.frames import only


def table_3_1(results):
    return build_item(report, "tables", "table_3_1", results)


def test_intervals_of_learned_weights_are_those_of_the_objects(seen, small):
    _, values = small.learned_weights()
    row = only(table_3_1(seen).frame, dataset="gaze", method="guided_ssim", channel="color")
    assert row[["mean", "low", "high"]].tolist() == pytest.approx(interval(values[:, 0]), abs=1e-5)


def test_what_hues_change_stands_beside_the_weights_and_a_flat_map_has_none(seen, measure):
    row = {"item": "a", "method": "dkl", "metric": "grey_likeness", "value": 0.4}
    rows = [row, row | {"item": "b", "value": 0.6}, row | {"method": "color", "value": None}]
    results = measure("weights", seen.rows("weights", "gaze"), "gaze")
    results = measure("conspicuity", pd.DataFrame(rows), COLOURED, results)
    shown = table_3_1(results).shown.set_index("channel")["in colour: r with itself in grey"]
    assert shown["DKL"].startswith("0.50 [") and shown["color"] == "–"
