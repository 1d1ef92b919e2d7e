"""The stage on one small object."""

import dataclasses

import numpy as np
import pytest

from stages.stability.__main__ import chosen, process
from stages.stability.breaking import summarise


def value(rows, method, perturbation, severity, metric):
    values = [
        row["value"]
        for row in rows
        if (row["method"], row["perturbation"], row["severity"], row["metric"])
        == (method, perturbation, severity, metric)
    ]
    assert len(values) == 1
    return values[0]


@pytest.mark.slow
def test_a_disturbance_costs_who_is_disturbed_and_as_much_as_it_is_heavy(disturbed):
    rows = disturbed.rows
    for method in ("itti", "harris"):
        assert value(rows, method, "vertex_order", 1.0, "repeatability") == 1
        assert value(rows, method, "vertex_order", 1.0, "drift") < 1e-3
        light, heavy = (value(rows, method, "noise", s, "repeatability") for s in (0.001, 0.02))
        assert light > heavy
        light, heavy = (value(rows, method, "noise", s, "drift") for s in (0.001, 0.02))
        assert light < heavy
    assert value(rows, "harris", "light", 60.0, "repeatability") == 1  # it does not look
    assert value(rows, "itti", "light", 60.0, "repeatability") < 1


def test_random_points_are_at_the_level_of_chance(disturbed):
    """Drawn anew for each case, they are not found again although the object is the same."""
    rows = [row for row in disturbed.rows if row["method"] == "random" and row["value"] is not None]
    mean = {m: np.mean([row["value"] for row in rows if row["metric"] == m]) for m in ("repeatability", "chance")}
    assert mean["repeatability"] < 0.25 and mean["repeatability"] == pytest.approx(mean["chance"], abs=0.12)
    assert not any(row["metric"] == "drift" for row in rows)


def test_rows_are_complete_and_what_cannot_be_done_says_why(disturbed, settings):
    plain = [row for row in disturbed.rows if row["perturbation"] == "none"]
    assert [(row["method"], row["metric"]) for row in plain] == [(method, "points") for method in settings.methods]
    measured = {(row["perturbation"], row["severity"]) for row in disturbed.rows if row["metric"] == "chance"}
    expected = {(name, s) for name, all_of in settings.severities.items() for s in all_of}
    assert measured == expected - {("missing_faces", 1.0)}
    assert all(row["seconds"] > 0 for row in disturbed.rows if row["value"] is not None)
    rows = [row for row in disturbed.rows if (row["perturbation"], row["severity"]) == ("missing_faces", 1.0)]
    assert [row["method"] for row in rows] == settings.methods
    assert all(row["value"] is None and "no surface" in row["note"] for row in rows)
    summary = summarise(disturbed.rows)
    keys = {f"{name}.{method}" for name in settings.severities for method in settings.methods}
    assert set(summary["repeatability"]) == set(summary["breaking_point"]) == keys
    assert summary["breaking_point"]["vertex_order.itti"] is None and summary["breaking_point"]["noise.itti"] > 0


@pytest.mark.slow
def test_rows_are_the_same_twice(disturbed, settings, tmp_path):
    harris = dataclasses.replace(settings, methods=["harris"])
    rows = process("pear", tmp_path, disturbed.root / "data/test", harris, 0)
    before = [row for row in disturbed.rows if row["method"] == "harris"]
    assert [row["value"] for row in rows] == [row["value"] for row in before]


def test_objects_are_the_wanted_ones_or_else_the_first(settings):
    settings = dataclasses.replace(settings, objects=["cup", "hand"], most=2)
    assert chosen(settings, ["ant", "cup", "hand"]) == ["cup", "hand"]
    assert chosen(settings, ["ant", "bee", "cat"]) == ["ant", "bee"]
