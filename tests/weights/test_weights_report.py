"""Table 3.1: the learned weights."""

import pytest

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
