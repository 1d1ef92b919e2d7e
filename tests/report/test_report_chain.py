"""The front in the report: what was confirmed beside what was searched, and the effect of each changed choice."""

import numpy as np
import pandas as pd
import pytest

from stages.report import chain
from stages.report.chain import smallest_kept
from stages.report.parts import build_item

BLIND = {"method": "random", "points": 40, "cells": 8, "level": "500", "touches": 3, "classifier": "knn"}
LOOKING = BLIND | {"method": "thesis_ssim", "viewpoints": "twelve", "image_rows": 900, "level": "100%", "touches": 1}
OTHERS = [BLIND | {"points": 20}, BLIND | {"classifier": "svm"}]


def choice_rows(rung, number, options, accuracy, seconds, role=None):
    """Rows of one choice on six shapes and six objects, whose accuracies spread evenly around their mean."""
    random, common = np.random.default_rng(number), {"method": None, "viewpoints": None, "image_rows": None} | options
    common |= {"rung": rung, "number": number, "role": role, "metric": "accuracy", "seconds": seconds, "faces": 500}
    common |= {"simplifying": 0, "looking": seconds, "pressing": 0, "asking": 0, "training": 1, "seed": 0}
    spread = 0.1 * (random.permutation(6) - 2.5) / 2.5
    return [
        common | {"split": split, "group": group, "item": f"{split} {k}", "value": accuracy + spread[k]}
        for split, group in (("regions", None), ("objects", "table"))
        for k in range(6)
    ]


@pytest.fixture(scope="module")
def measured(measure):
    rows = choice_rows("confirmation", 5, LOOKING, 0.55, 1.0, "default")
    rows += choice_rows("confirmation", 0, BLIND, 0.5, 0.01, "smallest")
    rows += choice_rows("confirmation", 1, OTHERS[0], 0.45, 0.005)
    for rung in ("wide", "narrow", "last"):
        rows += choice_rows(rung, 0, BLIND, 0.6, 0.01) + choice_rows(rung, 1, OTHERS[0], 0.5, 0.005)
    rows += choice_rows("one_choice", 1, OTHERS[0], 0.4, 0.005) + choice_rows("one_choice", 7, OTHERS[1], 0.52, 0.02)
    frame = pd.DataFrame(rows)
    return measure("front", frame.assign(dataset=frame["split"].map({"regions": "test", "objects": "classes"})))


@pytest.mark.slow
def test_confirmed_choices_stand_beside_what_the_search_found(measured):
    table = build_item(chain, "tables", "front", measured)
    assert list(table.frame["number"]) == [1, 0, 5]  # the quickest first
    small = table.frame.iloc[1]
    assert small["regions"] == pytest.approx(0.5) and small["regions_searched"] == pytest.approx(0.6)
    assert small["regions_low"] < 0.5 < small["regions_high"] and np.isnan(table.frame.iloc[2]["regions_searched"])
    assert small["regions_over"] == pytest.approx(-5) and small["regions_over_low"] < -5 < small["regions_over_high"]
    assert "takes 10 ms, the default 1,000 ms" in " ".join(table.notes)
    assert "takes 10 ms" in build_item(chain, "tradeoff", "front", measured).caption


def test_defaults_follow_the_quickest_choice_that_is_as_good_as_the_best_in_both_accuracies():
    columns = ["regions", "regions_low", "objects", "objects_low", "seconds", "faces", "touches", "words"]
    best, quick = (0.7, 0.6, 0.6, 0.5, 1.0, 500, 1, "best"), (0.6, 0.5, 0.5, 0.4, 0.2, 500, 1, "quick")
    worse = [(0.59, 0.5, 0.6, 0.5, 0.1, 500, 1, "touched worse"), (0.8, 0.7, 0.49, 0.4, 0.1, 500, 1, "unseen worse")]
    frame = pd.DataFrame([best, *worse, quick], columns=columns)
    assert smallest_kept(frame)["words"] == "quick" and smallest_kept(frame[:3])["words"] == "best"
    assert smallest_kept(frame.assign(seconds=1.0, faces=[500, 500, 500, 1000]))["words"] == "best"


def test_each_changed_choice_has_its_paired_effect_and_its_cost(measured):
    frame = build_item(chain, "tables", "front_changed", measured).frame.set_index("stage")
    assert list(frame.index) == ["points", "classifier"]
    assert frame.loc["points", "regions"] == pytest.approx(-10) and frame.loc["points", "times"] == pytest.approx(0.5)
    assert frame.loc["classifier", "objects"] == pytest.approx(2) and frame.loc["classifier", "times"] == 2
    assert frame.loc["classifier", "objects_low"] < 2 < frame.loc["classifier", "objects_high"]
