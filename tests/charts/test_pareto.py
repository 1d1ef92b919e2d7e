"""The chart of accuracy against cost."""

from itertools import combinations

import numpy as np
import pandas as pd
import pytest
from matplotlib.text import Text

from stages.charts.drawing import place_names, plt
from stages.charts.pareto import OFF, ON, PERHAPS, attention_seconds, pareto_chart, pareto_front, placed, ticks
from stages.charts.results import NotRun


@pytest.mark.parametrize(("cost", "accuracy", "better", "front"), [
    ([1, 2, 3, 4, 2], [0.5, 0.7, 0.6, 0.9, 0.4], "high", [True, True, False, True, False]),
    ([1, 2, 3], [0.3, 0.1, 0.2], "low", [True, True, False]),
    ([1, 1, 2], [0.5, 0.5, 0.5], "high", [True, True, False]),  # equal choices stand together
    ([1, np.nan, 2], [0.1, 0.9, np.nan], "high", [True, False, False]),  # what was not measured
])  # fmt: skip
def test_front_of_a_known_set(cost, accuracy, better, front):
    assert pareto_front(cost, accuracy, better=better).tolist() == front


def test_no_choice_on_the_front_is_beaten_and_every_other_is():
    rng = np.random.default_rng(1)
    cost, accuracy = rng.integers(0, 6, 60), rng.integers(0, 6, 60)
    front = pareto_front(cost, accuracy)
    for k in range(60):
        as_good = (cost <= cost[k]) & (accuracy >= accuracy[k])
        beaten = (as_good & ((cost < cost[k]) | (accuracy > accuracy[k]))).any()
        assert front[k] != beaten


def choices(accuracy, spread, seconds=(1.0, 2.0)):
    """Two choices with intervals of a half-width."""
    mean = np.array(accuracy)
    ends = {"low": mean - spread, "high": mean + spread}
    return pd.DataFrame({"name": ["cheap", "dear"], "seconds": seconds, "mean": mean, **ends})


EQUAL = (1.0, 1.0)  # seconds: with noise either of two choices is cheaper half of the time


@pytest.mark.parametrize(("accuracy", "spread", "options", "words"), [
    ([0.5, 0.9], 0.1, {}, [ON, ON]), ([0.9, 0.5], 0.1, {}, [ON, OFF]), ([0.5, 0.51], 0.1, {}, [ON, PERHAPS]),
    ([0.5, 0.6], 0.01, {"seconds": EQUAL, "noise": 0.0}, [OFF, ON]),
    ([0.5, 0.6], 0.01, {"seconds": EQUAL, "noise": 0.25}, [PERHAPS, ON]),
    ([0.5, 0.9], 0.01, {"better": "low"}, [ON, OFF]),
])  # fmt: skip
def test_a_choice_is_on_the_front_where_resamples_agree(accuracy, spread, options, words):
    frame = choices(accuracy, spread, options.pop("seconds", (1.0, 2.0)))
    front = placed(frame, "seconds", "mean", **options)
    assert front["on_front"].tolist() == words
    if accuracy[1] == 0.51:
        assert front["front_share"].iloc[1] == pytest.approx(0.56, abs=0.05)  # half, and a little for the 0.01


def test_units_drawn_together_tell_a_small_gain_from_chance():
    """Two choices vary by far more between objects than they differ on each."""
    objects = np.random.default_rng(0).normal(0.5, 0.2, 40)
    units = pd.DataFrame({"cheap": objects, "dear": objects + 0.02})
    frame = choices(units.mean().to_list(), 0.06)
    assert placed(frame, "seconds", "mean")["on_front"].tolist() == [ON, PERHAPS]
    assert placed(frame, "seconds", "mean", units=units)["on_front"].tolist() == [ON, ON]


@pytest.mark.slow
def test_the_cost_axis_has_seconds_of_a_named_clock_and_a_long_front_is_told_by_its_ends():
    words = {"title": "T", "quality_label": "accuracy", "clock": "processor, Model X"}
    figure = pareto_chart(frame(), "mean", reference="fast", **words)
    above = figure.drawing.axes[0].child_axes[0]
    assert above.get_xlabel() == "seconds, processor, Model X" and "processor, Model X" in figure.words["caption"]
    low, high = figure.drawing.axes[0].get_xlim()
    figure.drawing.draw_without_rendering()
    assert above.get_xlim() == pytest.approx((2 * low, 2 * high))  # the reference takes two seconds
    many = pd.DataFrame({"name": [f"n{k}" for k in range(12)], "seconds": range(1, 13), "mean": range(12)})
    caption = pareto_chart(many, "mean", reference="n3", **words | {"clock": ""}).words["alt"]
    assert "12, from n0 to n11" in caption and "n5" not in caption


def frame():
    rows = {"name": ["slow", "fast", "poor"], "seconds": [4.0, 2.0, 8.0], "mean": [0.9, 0.5, 0.4]}
    return pd.DataFrame(rows | {"low": [0.8, 0.4, np.nan], "high": [1.0, 0.6, np.nan]})


def chart(folder, reference="fast"):
    figure = pareto_chart(frame(), "mean", title="Title", reference=reference, quality_label="accuracy")
    figure.name = "chart"
    figure.write(folder)
    return figure


@pytest.mark.parametrize("span", [1.05, 2.9, 3.1, 50, 1e4])
def test_the_axis_of_costs_has_numbers_however_narrow_it_is(span):
    figure, axes = plt.subplots()
    axes.set_xscale("log")
    axes.plot([1, span], [0, 1])
    axes.xaxis.set_major_locator(ticks(span))
    low, high = axes.get_xlim()
    assert 2 <= sum(low <= tick <= high for tick in axes.get_xticks()) <= 9
    plt.close(figure)


@pytest.mark.slow
def test_cost_is_a_ratio_to_the_named_reference_and_equal_charts_have_equal_bytes(tmp_path):
    figure = chart(tmp_path)
    table = pd.read_csv(tmp_path / "chart.csv").set_index("name")
    assert table["cost_ratio"].to_dict() == {"slow": 2.0, "fast": 1.0, "poor": 4.0}
    assert table["on_front"].to_dict() == {"slow": ON, "fast": ON, "poor": OFF}
    assert "fast" in figure.words["alt"] and "poor" not in figure.words["alt"]
    chart(tmp_path / "again")
    assert (tmp_path / "chart.png").read_bytes() == (tmp_path / "again/chart.png").read_bytes()
    with pytest.raises(NotRun, match="nobody"):
        chart(tmp_path, reference="nobody")


def crowded():
    """An axis with points in each other's way, and lines through them."""
    points = np.array([[1, 0.5], [1.02, 0.52], [1.5, 0.52], [9, 0.5], [9.1, 0.53], [9, 0.9]])
    figure, axes = plt.subplots(figsize=(7, 4))
    axes.set(xscale="log", xlim=(0.8, 12), ylim=(0, 1))
    names = [(f"a name that takes room, {k}", tuple(point)) for k, point in enumerate(points)]
    return figure, axes, names, points


@pytest.mark.slow
def test_names_cover_neither_each_other_nor_a_point_nor_the_edge():
    figure, axes, names, points = crowded()
    written = place_names(axes, names, points, [((1, 0.2), (1, 0.8))])
    assert len(written) >= len(names) - 1
    figure.draw_without_rendering()
    renderer = figure.canvas.get_renderer()
    boxes = [Text.get_window_extent(text, renderer) for text in written]
    for first, second in combinations(boxes, 2):
        assert not first.overlaps(second)
    for box in boxes:
        assert not any(box.contains(*spot) for spot in axes.transData.transform(points))
        assert axes.get_window_extent().count_contains(box.corners()) == 4
    plt.close(figure)


def test_cost_counts_views_channels_and_points(seen):
    cost = attention_seconds(seen, "gaze")
    assert cost["itti"] == pytest.approx(2 + 3 + 0.5)
    assert cost["facing_viewer"] == pytest.approx(0.5)
