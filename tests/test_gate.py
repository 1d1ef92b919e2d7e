"""The gate passes what holds, and names what moved and by how much."""

import pytest

from stages import gate
from stages.kit.files import write_json


def test_equal_metrics_pass_and_a_moved_one_is_named():
    metrics = {"a.accuracy": 0.5, "a.objects": 50}
    bounds = gate.baseline(metrics)
    assert gate.compare(metrics, bounds) == []
    (line,) = gate.compare({**metrics, "a.accuracy": 0.4}, bounds)
    assert "a.accuracy moved by -0.1 from 0.5 to 0.4" in line


def test_counts_are_held_exactly_and_missing_metrics_are_named():
    bounds = gate.baseline({"objects": 50, "error": 0.001})
    assert len(gate.compare({"objects": 49, "error": 0.001}, bounds)) == 1
    assert gate.compare({"objects": 50}, bounds) == ["error is missing (baseline 0.001)"]


def test_small_errors_have_narrow_bands():
    bounds = gate.baseline({"error": 0.0006})
    assert gate.compare({"error": 0.0008}, bounds)


def test_a_rate_near_zero_has_room_and_a_count_beside_it_none():
    bounds = gate.baseline({"toys.stability.noise": 0.01, "toys.stability.objects": 4})
    assert gate.compare({"toys.stability.noise": 0.09, "toys.stability.objects": 4}, bounds) == []
    assert len(gate.compare({"toys.stability.noise": 0.2, "toys.stability.objects": 5}, bounds)) == 2


def test_not_a_number_never_passes():
    assert gate.compare({"x": float("nan")}, gate.baseline({"x": 1.0}))


def test_nested_metrics_are_flat_and_intervals_are_left_out():
    assert gate.flatten({"a": {"b": {"value": 1.0, "low": 0, "high": 2}}, "c": True}) == {"a.b.value": 1.0, "c": True}


@pytest.fixture
def workspace(make_workspace):
    """A set `toys` with one stage, beside the metrics of a set that is not switched on."""
    found = make_workspace({"lod": {}})
    write_json(found.metrics / "lod.json", {"meshes": 100, "error": 0.5})
    write_json(found.on("other").metrics / "lod.json", {"error": 3})
    write_json(found.reports / "metrics/report.json", {"claims": {"open": 3}, "tables": 2})
    gate.hold(found, update=True)
    return found


def test_the_gate_names_what_moved(workspace):
    assert "3 metrics within" in gate.hold(workspace)
    write_json(workspace.metrics / "lod.json", {"meshes": 100, "error": 0.1})
    with pytest.raises(SystemExit, match=r"1 of 3 metrics left .*\n.*toys.lod.error moved by -0.4"):
        gate.hold(workspace)


def test_only_sets_that_are_switched_on_count_and_verdicts_are_free(workspace):
    assert gate.measured(workspace) == {"toys.lod.meshes": 100, "toys.lod.error": 0.5, "report.tables": 2}


def test_counts_that_follow_from_measured_values_have_a_band():
    assert gate.compare({"toys.lod.meshes": 95}, gate.baseline({"toys.lod.meshes": 100})) == []
