"""Breaking points of recognition by touch, on rows with a known truth."""

from functools import partial

import numpy as np
import pandas as pd
import pytest

from stages.report.parts import build_item
from stages.touch_stability import report
from stages.touch_stability.report import breaking, curve, harmless


def disturbed():
    """Rows in which noise halves the lead of kNN at 0.2, and coarse models do no harm down to 400 faces."""
    lost = {("noise", 0.1): 0.1, ("noise", 0.2): 0.3, ("noise", 0.4): 0.5, ("coarse_model", 400.0): 0.01,
            ("coarse_model", 100.0): 0.2, ("none", 0.0): 0.0}  # fmt: skip
    generator, rows = np.random.default_rng(0), []
    for repetition in range(8):
        for (perturbation, severity), loss in lost.items():
            row = {"dataset": "test", "group": "six", "method": "glance", "split": "random", "features": "imprint"}
            row |= {"classifier": "knn", "repetition": repetition, "perturbation": perturbation, "severity": severity}
            value = 0.8 - loss + 0.002 * generator.normal()
            rows.append(row | {"chance": 0.2, "metric": "accuracy", "value": value, "seconds": 1e-3, "note": None})
    return pd.DataFrame(rows)


def test_half_of_the_lead_is_lost_where_the_rows_say_so_and_severities_go_from_mild_to_harsh():
    points = curve(disturbed(), "noise", ("random", "imprint", "knn"))
    at, low, high = breaking(points, "noise")
    assert at == pytest.approx(0.2, abs=0.01) and low < at < high
    assert np.isnan(harmless(points))
    points = curve(disturbed(), "coarse_model", ("random", "imprint", "knn"))
    assert points["severity"].tolist() == [400, 100] and harmless(points) == 400


touch_stability = partial(build_item, report, "tables", "touch_stability")


def test_the_table_of_breaking_points_says_what_is_beyond_the_harshest(measure):
    shown = touch_stability(measure("touch_stability", disturbed())).shown.set_index("perturbation")
    assert shown.loc["coarse model", "kNN breaks at"].startswith("< 100")
    assert shown.loc["noise", "kNN breaks at"].startswith("0.2") and shown.loc["noise", "SVM breaks at"] == "–"


def test_what_is_no_better_than_guessing_has_no_breaking_point(measure):
    lost = disturbed()
    assert touch_stability(measure("touch_stability", lost.assign(value=lost["value"] - 0.7))).frame.empty
