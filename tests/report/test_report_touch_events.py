"""Touch events, grasps over time and nested choices in the report: tables and claims on rows whose truth is known."""

from itertools import product

import pandas as pd
import pytest

from stages.report import attention, recorded
from stages.report.recorded.claims import SERIES as CLAIMS
from stages.report.recorded.touch_events import PUBLISHED
from stages.report.results import NotRun
from stages.report.topics import build_one
from stages.report.verdict import judge

METHODS = {"discriminant": 0.96, "linear_svm": 0.9, "knn": 0.6}


def event_rows(levels=METHODS):
    """Ten objects that differ alike in all methods, and the accuracies of METHODS."""
    rows = []
    for group, (method, level), k in product(("objects", "containers"), levels.items(), range(10)):
        common = {"dataset": "touch_events", "group": group, "method": method, "item": f"{k:02}", "metric": "accuracy"}
        common |= {"bins": 10, "parameter": 0.1, "heard": 1.0, "cells": 39, "value": level + 0.004 * (k - 4.5)}
        rows.append(common | {"part": "test"})
        folded = common | {"part": "training", "split": "folds"}
        rows += [folded | {"heard": heard, "value": common["value"] * heard} for heard in (0.25, 1.0)]
        rows += [folded | {"cells": 20, "value": common["value"] - 0.01 - 0.001 * k}]
        rows += [folded | {"disturbance": "jitter", "severity": 5.0, "value": common["value"] / 2}]
        if k == 0:
            about = common | {"item": None, "part": "test"}
            rows += [about | {"metric": metric, "value": 2.0} for metric in ("milliseconds", "training_seconds")]
            rows.append(about | {"metric": "cross_validated", "value": level, "part": "training", "split": "folds"})
    return rows


def grasp_rows():
    """Twenty grasps, of which the discriminant knows all but one and kNN every other; of the list all and none."""
    found = []
    for method, k in product(("discriminant", "knn"), range(20)):
        right = float(k > 0 if method == "discriminant" else k % 2)
        row = {"dataset": "schunk", "group": "grasps", "method": method, "item": f"cup/{k}", "metric": "accuracy"}
        found.append(row | {"part": "training", "split": "objects", "value": right})
        if k < 5:
            found.append(row | {"part": "test", "split": "objects", "value": float(method == "discriminant")})
    return found


@pytest.fixture
def measured(results, monkeypatch):
    """A function that puts rows in the place of those of a stage and set."""
    stored = {}
    read = type(results)._read
    monkeypatch.setattr(type(results), "_read", lambda self, stage, dataset: stored.get((stage, dataset)) if (
        stage, dataset) in stored else read(self, stage, dataset))  # fmt: skip

    def put(stage, dataset, rows):
        stored[stage, dataset] = pd.DataFrame(rows)
        return results

    return put


def test_methods_stand_beside_the_published_ones_with_what_they_take(measured):
    table = build_one(recorded, "tables", "touch_events", measured("recorded", "touch_events", event_rows()))
    lines = table.text.set_index("method")
    assert lines.loc["linear discriminant", "36 objects"].startswith("96.00 [")
    assert lines.loc["kNN", "linear discriminant − it, objects"].startswith("+36.0")
    assert lines.loc["published: TactileSGNet, spiking graph network (Gu and others 2020)", "20 containers"] == "64.17"
    assert len(lines) == len(METHODS) + len(PUBLISHED)
    assert "36 objects linear discriminant, 96.0" in "\n".join(table.notes)


def test_what_it_takes_has_a_row_a_condition(measured):
    table = build_one(recorded, "tables", "touch_events_conditions", measured("recorded", "touch_events", event_rows()))
    levels = table.text.groupby("condition")["level"].apply(list).to_dict()
    assert levels == {
        "share of the touch heard": ["0.250", "1"], "taxels": ["20", "39"],
        "deviation of an event's time, steps": ["5"],
    }  # fmt: skip


def test_the_chart_has_a_line_a_method_and_the_network(measured):
    chart = build_one(recorded, "tradeoff", "touch_events_heard", measured("recorded", "touch_events", event_rows()))
    assert set(chart.frame["method"]) == set(METHODS) and set(chart.frame["heard"]) == {0.25, 1.0}


def test_grasps_are_counted_one_by_one(measured):
    results = measured("recorded", "schunk", grasp_rows())
    table = build_one(recorded, "tables", "grasp_series", results)
    assert table.text["published test list"].tolist() == ["5 of 5", "0 of 5"]
    assert table.text["grasps left out in turn, %"].str.split(" ").str[0].tolist() == ["95", "50"]
    (claim,) = [one for one in CLAIMS if one.key == "grasp_series_over_components"]
    assert judge([claim], results).loc[0, "effect"] == pytest.approx(45)


def test_claims_on_events_turn_with_the_rows(measured):
    events = [one for one in CLAIMS if one.dataset == "touch_events"]
    results = measured("recorded", "touch_events", event_rows())
    words = judge(events, results).set_index("key")["verdict"]
    assert words["events_discriminant_over_network_objects"] == "supported"
    assert words["events_linear_svm_over_network_containers"] == "supported"
    assert words["events_quarter_enough"] == "contradicted" and words["events_half_the_taxels_objects"] == "supported"
    results = measured("recorded", "touch_events", event_rows(dict.fromkeys(METHODS, 0.5)))
    words = judge(events, results).set_index("key")["verdict"]
    assert words["events_discriminant_over_network_objects"] == "contradicted"


def nested_rows():
    """The glance on six objects: nesting costs it a tenth of NSS each."""
    rows = []
    for way, k in product(("once", "nested"), range(6)):
        lost = 0.1 * (1 + 0.01 * k) if way == "nested" else 0.0
        numbers = {
            "nss": 1.5 + 0.1 * k - lost,
            "auc": 0.8 + 0.01 * k,
            "features": 3 if way == "once" else 1 + k % 2,
            "ridge": 0.03,
        }
        names = ["rank", "seen", "detail"][: int(numbers["features"])]
        common = {"dataset": "gaze", "method": f"glance_{way}", "item": f"o{k}", "chosen": ", ".join(names)}
        rows += [common | {"metric": metric, "value": value} for metric, value in numbers.items()]
    return rows


def test_nested_choices_stand_beside_those_made_once(measured):
    results = measured("attention_checks", "gaze", nested_rows())
    lines = build_one(attention, "tables", "attention_nested", results).text
    assert lines["flattered by, NSS"].str[:5].tolist() == ["+0.10"]
    assert lines["features"].tolist() == ["1 to 2 (once: 3)"] and set(lines["in every choice"]) == {"rank"}
    claims = [one for one in attention.CLAIMS if one.key.startswith("gaze_choices")]
    assert judge(claims, results).set_index("key")["verdict"].tolist() == ["supported"]


def test_without_nested_rows_the_table_is_not_run(measured):
    rows = [row for row in nested_rows() if row["method"].endswith("_once")]
    with pytest.raises(NotRun):
        build_one(
            attention,
            "tables",
            "attention_nested",
            measured("attention_checks", "gaze", [{**rows[0], "method": "equal"}]),
        )
