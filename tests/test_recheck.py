"""Committed rows beside the same rows measured again, of a stage that takes a second."""

import gzip
import shutil
from types import SimpleNamespace

import pandas as pd
import pytest

from haptic_glance.base.files import read_json, write_mesh, write_text
from stages import recheck
from stages.engine.rows import RECHECKED, agrees, read_rows
from stages.recheck import EQUAL, by_method, chain, compared, run
from stages.recheck import outcome as outcome_of
from stages.views import __main__ as views

SECTION = {"viewpoints": "four", "size": [45, 60], "background": "black", "compare_sets": False}


@pytest.fixture
def committed(shapes, make_workspace, tmp_path, monkeypatch):
    """The committed rows of the views of two meshes, in a folder that is the current one."""
    workspace = make_workspace({"views": SECTION})
    for name in ("torus", "cube"):
        write_mesh(workspace.data / "meshes" / f"{name}.npz", shapes[name])
    views.run(workspace)
    clone = tmp_path / "clone"
    target = clone / recheck.COMMITTED / "toys/views.csv.gz"
    target.parent.mkdir(parents=True)
    shutil.copyfile(workspace.measurements / target.name, target)
    (clone / "dvc.yaml").touch()
    monkeypatch.chdir(clone)
    monkeypatch.setattr(recheck, "prepared", lambda dataset, settings: workspace)
    monkeypatch.setattr(recheck, "chain", lambda stage: [])
    # digests of all stages take seconds
    monkeypatch.setattr(recheck, "write_digests", lambda folder: write_text(folder / "views", "digest"))
    return target


def outcome(committed):
    return read_json(committed.parents[1] / RECHECKED)["toys/views"]


def test_equal_rows_of_the_first_items_are_kept_as_close_and_another_value_is_named(committed, capsys):
    whole = committed.read_bytes()
    rows = read_rows(committed)
    count = (rows["item"] == "cube").sum()
    assert run(["toys/views", "--items", "1"]) == 0
    assert outcome(committed)["compared"] == outcome(committed)["close"] == count < len(rows)
    assert committed.read_bytes() == whole
    value = rows.loc[rows["item"] == "cube", "value"].iloc[0]
    committed.write_bytes(gzip.compress(gzip.decompress(whole).replace(f"{value:.6g},".encode(), b"0.9123,", 1)))
    assert run(["toys/views", "--items", "1"]) == 1
    assert outcome(committed)["close"] == count - 1
    assert f"raster     {count}      {count - 1}" in capsys.readouterr().out


def test_rows_about_all_items_are_compared_when_all_were_measured_again(committed, monkeypatch):
    names = gzip.decompress(committed.read_bytes()).decode().splitlines()[0].split(",")
    values = {"dataset": "toys", "method": "all", "metric": "coverage", "value": "4"}
    line = ",".join(values.get(name, "") for name in names)
    committed.write_bytes(gzip.compress(gzip.decompress(committed.read_bytes()) + f"{line}\n".encode()))

    def with_a_row_about_all(workspace):
        views.run(workspace)
        shutil.copyfile(committed, workspace.measurements / committed.name)

    monkeypatch.setattr(recheck, "_run", lambda stage, workspace: with_a_row_about_all(workspace))
    assert run(["toys/views"]) == 0
    everything = outcome(committed)["compared"]
    assert everything == len(read_rows(committed))
    assert run(["toys/views", "--items", "1"]) == 0
    assert 0 < outcome(committed)["compared"] < everything - 1


def test_a_stage_that_stops_is_not_kept_and_the_next_file_goes_on(committed, monkeypatch, capsys):
    def stops(stage, workspace):
        views.run(workspace)
        raise KeyError("cube")

    with monkeypatch.context() as patch:
        patch.setattr(recheck, "_run", stops)
        assert run(["toys/views", "--items", "1"]) == 1
    assert "toys/views is not kept, views stopped before its end: 'cube'" in capsys.readouterr().err
    assert not (committed.parents[1] / RECHECKED).exists()
    assert run(["toys/lod", "toys/views", "--items", "1"]) == 1
    assert "no reports/measurements/toys/lod.csv.gz; known: toys/views" in capsys.readouterr().err
    assert outcome(committed)["compared"] > 0


def test_a_stage_of_an_experiment_is_switched_on_by_its_name(committed, monkeypatch, capsys):
    calls = []

    def without_views(dataset, settings):
        calls.append((dataset, settings))
        return workspace

    workspace = SimpleNamespace(params={"graph": {"views": ["others"]}})
    monkeypatch.setattr(recheck, "prepared", without_views)
    assert run(["seed=3", "toys/views", "profile=smoke"]) == 1
    assert calls == [("toys", ["seed=3", "profile=smoke"])]
    assert "conf/data/toys.yaml leaves views out; add experiment=NAME" in capsys.readouterr().err


@pytest.mark.slow
def test_settings_of_an_experiment_switch_its_stage_on(tmp_path, monkeypatch):
    monkeypatch.setattr(recheck, "FOLDER", tmp_path)
    graph = recheck.prepared("furniture", ["experiment=coarse_imprints"]).params["graph"]
    assert graph["coarse_imprints"] == ["furniture"] and recheck.prepared("furniture").params["graph"]["contours"]


def test_a_setting_may_stand_behind_the_number_of_items(committed, capsys):
    assert run(["off/views", "--items", "1", "seed=3"]) == 1
    assert "recheck: no reports/measurements/off/views.csv.gz" in capsys.readouterr().err


def test_a_number_of_items_below_one_is_named(committed):
    with pytest.raises(ValueError, match="--items 0: give 1 or more"):
        run(["toys/views", "--items", "0"])


def frame(**columns):
    common = {"dataset": "s", "item": ["a", "a", "b"], "method": ["x", "y", "x"], "metric": "m", "note": ""}
    return pd.DataFrame(common | {"value": [1.0, 2.0, 3.0], "seconds": 1.0} | columns)


@pytest.mark.parametrize(
    ("again", "counts"),  # of method x: rows, equal, close, only committed, only again
    [
        (frame(seconds=9.0, note="other", points=3), [2, 2, 2, 0, 0]),  # what tells no rows apart does not count
        (frame(value=[1.0 + 1e-6, 2.0, 3.0]), [2, 2, 2, 0, 0]),
        (frame(value=[1.005, 2.0, 3.0]), [2, 1, 2, 0, 0]),
        (frame(value=[1.02, 2.0, 3.0]), [2, 1, 1, 0, 0]),
        (frame(value=[None, 2.0, 3.0]), [2, 1, 1, 0, 0]),
        (frame(value=[0.0, 2.0, 3.0]), [2, 1, 1, 0, 0]),
        (frame(metric=["m", "m", "n"]), [1, 1, 1, 1, 1]),
        (frame().iloc[:2], [1, 1, 1, 0, 0]),  # object b was not measured again
        (frame().iloc[1:], [1, 1, 1, 1, 0]),  # a row of object a is gone
    ],
)
def test_rows_are_compared_by_all_that_tells_them_apart(again, counts):
    row = by_method(compared(frame(), again)).set_index("method").loc["x"]
    assert list(row[["rows", "equal", "close", "only_committed", "only_again"]]) == counts


def test_rows_of_a_trial_count_where_another_metric_of_it_was_measured_again():
    trials = frame(item="", method="x", repetition=[0, 0, 1], metric=["m", "n", "m"])
    assert outcome_of(compared(trials, trials.iloc[:1])) == {
        "compared": 1,
        "close": 1,
        "only_committed": 1,
        "least": 1.0,
    }


def test_one_method_of_many_that_differs_is_seen_and_times_do_not_count():
    rows = pd.concat([frame(item=f"{number}") for number in range(100)])
    again = rows.assign(value=rows["value"].where(rows["method"] == "x", 2.2))
    again.iloc[0, again.columns.get_loc("value")] = 7.0
    counts = outcome_of(compared(rows, again))
    assert counts == {"compared": 300, "close": 199, "only_committed": 0, "least": 0.0} and not agrees(counts)
    times = rows.assign(metric="milliseconds")
    assert outcome_of(compared(times, times.assign(value=9.0)))["compared"] == 0


def test_values_that_are_absent_on_both_sides_or_zero_but_for_rounding_are_equal():
    nothing, zero, rounding = (
        frame(value=[None, 2.0, 3.0]),
        frame(value=[0.0, 2.0, 3.0]),
        frame(value=[2e-16, 2.0, 3.0]),
    )
    assert (compared(nothing, nothing)["off"] == 0).all()
    assert (compared(zero, rounding)["off"] < EQUAL).all()


@pytest.mark.parametrize(
    ("counts", "expected"),
    [
        ({"compared": 300, "close": 300, "only_committed": 0, "least": 1.0}, True),
        ({"compared": 300, "close": 299, "only_committed": 0, "least": 0.98}, True),
        ({"compared": 300, "close": 299, "only_committed": 0, "least": 0.97}, False),
        ({"compared": 300, "close": 300, "only_committed": 1, "least": 1.0}, False),
        ({"compared": 0, "close": 0, "only_committed": 0, "least": 0.0}, False),
    ],
)
def test_rows_agree_where_nearly_all_of_each_method_were_measured_again_and_are_close(counts, expected):
    assert agrees(counts) == expected


def test_a_stage_stands_behind_all_that_it_reads():
    assert chain("lod") == ["meshes", "views", "conspicuity", "weights", "salient_points"]
    assert chain("meshes") == []
