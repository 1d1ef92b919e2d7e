"""The pressure array in the report: its table, its chart and its claims, on rows with a known truth."""

import numpy as np
import pandas as pd
import pytest

from stages.engine.statistics import interval
from stages.report.parts import build_item
from stages.sensor_size import report as sensor


def pressed():
    """Rows in which 32 x 32 cells and larger sensels are better by ten points each, kNN by five."""
    random, rows = np.random.default_rng(0), []
    for cells in (16, 32):
        for pitch in (0.002, 0.01, 0.02):
            common = {"dataset": "furniture", "method": "glance", "cells": cells, "pitch": pitch, "touches": 60}
            seconds = 1e-4 * cells / 16 * (6 if pitch == 0.002 else 1)
            rows.append(common | {"metric": "seconds_a_touch", "value": seconds, "seconds": 1.0})
            for k, label in enumerate(np.repeat(["chair", "vase", "lamp", "sofa"], 2)):
                for name, better in (("knn", 0.05), ("svm", 0.0)):
                    value = 0.4 + 0.1 * (cells == 32) + 0.1 * (pitch > 0.002) + better + 0.01 * random.normal()
                    row = {"classifier": name, "group": label, "item": f"o{k}", "fold": k % 2, "metric": "accuracy"}
                    row |= {"seconds": 0.1}
                    rows.append(common | row | {"split": "objects", "value": value})
                    rows.append(common | row | {"split": "random", "value": value + 0.2 + 0.01 * random.normal()})
    return pd.DataFrame(rows)


@pytest.mark.slow
def test_a_cost_has_the_interval_of_its_objects(measure):
    rows = pressed()
    timed = rows[rows["metric"] == "seconds_a_touch"]
    objects = [timed.assign(item=f"o{k}", value=timed["value"] * factor) for k, factor in enumerate((0.9, 1.0, 1.1))]
    results = measure("sensor_size", pd.concat([rows[rows["metric"] != "seconds_a_touch"], *objects]))
    axes = build_item(sensor, "tradeoff", "sensor_size", results).drawing.axes[-1]
    assert max(line.get_ydata().max() for line in axes.lines) == pytest.approx(1.2)  # milliseconds of 32 cells
    low, high = axes.collections[-1].get_segments()[0][:, 1]
    assert [low, high] == pytest.approx(interval([0.09, 0.1, 0.11])[1:])
