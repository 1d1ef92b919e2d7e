"""Recognition of touches over time: what the bins hold, what is chosen on, and what a disturbance does."""

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.distance import pdist

from stages.recorded import series as schunk
from stages.recorded import splits as binned_module
from stages.recorded.series import TouchSeries
from stages.recorded.splits import METHODS, binned, choose, rotated
from stages.recorded.touch_events import disturbed, process


def series(count=8, classes=4, steps=60):
    """Touches of objects that differ by when one taxel, the same for all, has its events; the last two are tests."""
    random, names = np.random.default_rng(0), np.repeat([f"{k:02}" for k in range(classes)], count)
    values = (random.random((len(names), 39, 2, steps)) < 0.02).astype(np.uint8)
    for k in range(len(names)):
        start = 15 * (k // count)
        values[k, 20, 0, start : start + 10] = 1
    test = np.arange(len(names)) % count >= count - 2
    return TouchSeries(values, names, np.array([f"{k}" for k in range(len(names))]), test)


def test_bins_hold_the_logarithm_of_one_more_than_the_events():
    values = np.zeros((1, 39, 2, 10), np.uint8)
    values[0, 3, 1, [0, 4, 5]] = 1
    expected = np.zeros((39, 2, 2))
    expected[3, 1] = np.log1p([2, 1])
    assert binned(values, 2).reshape(39, 2, 2) == pytest.approx(expected, rel=1e-14)
    assert np.array_equal(binned(values, 2)[:, ::2], binned(values, 2, 0.5))
    cut = binned(values, 2, 0.4).reshape(39, 2, 1)  # four steps: not the fifth of the first bin
    assert cut[3, 1, 0] == pytest.approx(np.log(2), rel=1e-14)
    assert binned(values, 1, 0.5).sum() == pytest.approx(np.log(3), rel=1e-14)
    assert binned(values, 5, 0.5).shape == (1, 78 * 3)  # two bins and half of the third


def test_a_rotation_keeps_all_distances_on_fewer_axes():
    features = binned(series().values, 10)
    turned = rotated(features)
    assert turned.shape == (32, 32) and features.shape == (32, 780)
    assert np.allclose(pdist(turned), pdist(features))


@pytest.mark.slow
def test_time_is_divided_where_it_tells_the_objects_apart():
    touches = series()
    choice = choose("discriminant", touches.values, touches.labels, 1, 0)
    assert choice.bins > 1 and choice.accuracy > 0.9 and choice.parameter in METHODS["discriminant"][1]


@pytest.mark.parametrize("method", ["knn", "discriminant"])
@pytest.mark.slow
def test_the_test_part_changes_neither_the_choice_nor_what_is_measured_within_training(method, monkeypatch, tmp_path):
    monkeypatch.setattr(binned_module, "BINS", (4,))
    touches = series()
    other = TouchSeries(
        np.where(touches.test[:, None, None, None], 0, touches.values), *list(vars(touches).values())[1:]
    )
    first, second = (
        pd.DataFrame(process(("objects", method), tmp_path, {"objects": recording}, 1, 0))
        for recording in (touches, other)
    )
    timed = first["metric"].isin(["milliseconds", "training_seconds"])
    within = first["part"] == "training"
    assert first[within & ~timed].equals(second[within & ~timed])
    tested = (first["part"] == "test") & (first["metric"] == "accuracy")
    assert set(first.loc[tested, "item"]) == set(touches.labels) and set(first.loc[tested, "count"]) == {2}


@pytest.mark.slow
def test_less_is_heard_or_felt_and_less_is_known(monkeypatch, tmp_path):
    monkeypatch.setattr(binned_module, "BINS", (12,))
    rows = pd.DataFrame(process(("objects", "discriminant"), tmp_path, {"objects": series()}, 1, 0))
    tested = rows[(rows["part"] == "test") & (rows["metric"] == "accuracy")]
    assert tested["value"].mean() > 0.9 and set(tested["train"]) == {24} and set(tested["test"]) == {8}
    plain = rows[(rows["part"] == "training") & (rows["metric"] == "accuracy")]
    heard = plain[plain["disturbance"].isna() & (plain["cells"] == 39)].groupby("heard")["value"].mean()
    assert heard.index.tolist() == [0.1, 0.25, 0.5, 1.0] and heard[1.0] > 0.9 > heard[0.5] > heard[0.1]
    dropped = plain[plain["disturbance"] == "dropped_events"].groupby("severity")["value"].mean()
    assert dropped[0.1] >= dropped[0.75]
    assert plain.loc[plain["disturbance"] == "jitter", "value"].min() < heard[1.0]


def test_disturbances_do_what_they_say():
    touches = series().values
    dead = disturbed(touches, "dead_taxels", 0.4, np.random.default_rng(7))
    silent = ~dead.any(axis=(0, 2, 3))
    assert silent.sum() == round(0.4 * 39) and np.array_equal(dead[:, ~silent], touches[:, ~silent])
    dropped = disturbed(touches, "dropped_events", 0.25, np.random.default_rng(7))
    assert (dropped <= touches).all() and abs(dropped.sum() / touches.sum() - 0.75) < 0.02
    moved = disturbed(touches, "jitter", 5.0, np.random.default_rng(7))
    assert np.array_equal(moved.sum(axis=-1), touches.sum(axis=-1)) and not np.array_equal(moved, touches)


def test_each_grasp_is_left_out_one_time_with_one_of_each_object():
    touches = series(count=10, classes=3, steps=20)
    (listed, first), *rest = schunk.parts(touches)
    assert listed == "test" and np.array_equal(first, touches.test)
    assert {part for part, _ in rest} == {"training"} and np.array_equal(
        sum(out.astype(int) for _, out in rest), np.ones(30)
    )
    assert all(set(touches.labels[out]) == {"00", "01", "02"} for _, out in rest)


@pytest.mark.slow
def test_a_grasp_is_a_row_that_says_whether_it_is_known(monkeypatch, tmp_path):
    monkeypatch.setattr(binned_module, "BINS", (4,))
    rows = pd.DataFrame(schunk.process("discriminant", tmp_path, series(count=10, classes=3), 1, 0))
    assert set(rows["value"]) <= {0.0, 1.0} and (rows["part"] == "training").sum() == 30
    assert rows.loc[rows["part"] == "training", "item"].is_unique and rows["value"].mean() > 0.8
