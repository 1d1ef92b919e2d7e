"""The gate passes what holds, and names what moved and by how much."""

import pytest

from stages import gate


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
    bounds = gate.baseline({"stability.noise": 0.01, "stability.objects": 4})
    assert gate.compare({"stability.noise": 0.09, "stability.objects": 4}, bounds) == []
    assert len(gate.compare({"stability.noise": 0.2, "stability.objects": 5}, bounds)) == 2


def test_not_a_number_never_passes():
    assert gate.compare({"x": float("nan")}, gate.baseline({"x": 1.0}))


def test_nested_metrics_are_flat_and_intervals_are_left_out():
    assert gate.flatten({"a": {"b": {"value": 1.0, "low": 0, "high": 2}}, "c": True}) == {"a.b.value": 1.0, "c": True}


@pytest.mark.parametrize(("value", "code"), [(0.5, None), (0.1, 1)])
def test_the_command_ends_with_1_when_something_moved(tmp_path, monkeypatch, capsys, value, code):
    from stages.kit.files import write_json

    monkeypatch.chdir(tmp_path)
    (tmp_path / "params.yaml").write_text("profile: smoke\n")
    write_json("reports/baselines/smoke.json", gate.baseline({"m.accuracy": 0.5}))
    write_json("reports/metrics/m.json", {"accuracy": value})
    monkeypatch.setattr("sys.argv", ["gate"])
    if code is None:
        gate.main()
        assert "1 metrics within" in capsys.readouterr().out
    else:
        with pytest.raises(SystemExit) as stop:
            gate.main()
        assert "m.accuracy moved by -0.4" in str(stop.value)


def test_counts_that_follow_from_measured_values_have_a_band_and_verdicts_are_free(tmp_path):
    from stages.kit.files import write_json

    assert gate.compare({"lod.meshes": 95}, gate.baseline({"lod.meshes": 100})) == []
    write_json(tmp_path / "report.json", {"claims": {"open": 3}, "tables": 2})
    assert gate.measured(tmp_path) == {"report.tables": 2}
