"""Charts on a page: values, intervals and categories of their marks, as they were drawn; and charts as SVG."""

import re

import numpy as np
import pytest
from matplotlib.figure import Figure as Drawing

from stages.report.drawing import CYCLE, plt
from stages.report.marks import MOST_PATHS, has_marks_alone, marks, table, vector
from stages.report.page import part


@pytest.fixture
def panel():
    """(drawing, axes) of an empty chart."""
    drawing, axes = plt.subplots()
    yield drawing, axes
    plt.close(drawing)


def texts(drawing):
    drawing.draw_without_rendering()
    return [mark.text for mark in marks(drawing)]


def test_a_line_says_its_name_its_axes_and_its_values(panel):
    drawing, axes = panel
    axes.plot([1, 2], [0.5, 0.25], "o-", label="kNN")
    axes.plot([1.5], [0.3], "o", label="_hidden from the legend")
    axes.set(xlabel="noise", ylabel="accuracy", title="six")
    assert texts(drawing) == [
        "six · kNN · noise: 1 · accuracy: 0.500", "six · kNN · noise: 2 · accuracy: 0.250",
        "six · hidden from the legend · noise: 1.50 · accuracy: 0.300",
    ]  # fmt: skip


def test_a_bar_through_a_point_within_the_axes_is_its_interval_and_that_of_another_is_not(panel):
    drawing, axes = panel
    axes.plot([1, 2], [0.5, 0.6], "o")
    axes.plot([1, 1], [0.4, 0.7])
    axes.plot([1, 1], [0.1, 0.95])  # the narrowest counts
    axes.vlines([3], [0.1], [0.9])
    axes.plot([2, 100], [7, 0.6], "o")  # outside of the axes, as is what is not a number
    axes.plot([2], [np.nan], "o")
    axes.set(xlim=(0, 4), ylim=(0, 1))
    labels = texts(drawing)
    assert len(labels) == 2 and labels[0].endswith("0.500 [0.400, 0.700]") and labels[1].endswith("0.600")


@pytest.mark.parametrize("draw", [
    lambda axes: axes.vlines([1, 2], [0.4, 0.5], [0.6, 0.7]),
    lambda axes: axes.fill_between([1, 2], [0.4, 0.5], [0.6, 0.7]),
    lambda axes: axes.errorbar([1, 2], [0.5, 0.6], yerr=0.1, fmt="none"),
])  # fmt: skip
def test_intervals_are_read_from_bars_and_bands(panel, draw):
    drawing, axes = panel
    axes.plot([1, 2], [0.5, 0.6], "o")
    draw(axes)
    assert [text.partition("[")[2] for text in texts(drawing)] == ["0.400, 0.600]", "0.500, 0.700]"]


def test_level_bars_are_intervals_where_nothing_stands_upright(panel):
    drawing, axes = panel
    axes.plot([0.5], [3], "o")
    axes.hlines([3], [0.4], [0.8])
    assert texts(drawing)[0].endswith("[0.400, 0.800]")


def test_rules_steps_and_pictures_are_no_values(panel):
    drawing, axes = panel
    axes.axhline(1, ls=":")
    axes.axvline(1)
    axes.step([1, 2, 3], [1, 2, 3], where="post")
    axes.plot([0, 1], [0, 1])
    assert texts(drawing) == []
    axes.plot([1], [1], "o")
    axes.imshow(np.zeros((3, 3)))
    assert texts(drawing) == []


def test_bars_are_named_by_their_category_even_beside_its_middle(panel):
    drawing, axes = panel
    axes.bar(np.arange(2) - 0.2, [3, 4], 0.3, label="blind")
    axes.bar(np.arange(2) + 0.2, [5, 6], 0.3, label="guided")
    axes.set_xticks([0, 1], ["kNN", "SVM"])
    assert texts(drawing) == ["blind · kNN · 3", "blind · SVM · 4", "guided · kNN · 5", "guided · SVM · 6"]


def test_numbers_between_labelled_ticks_stay_numbers(panel):
    drawing, axes = panel
    axes.plot([1, 3, 4], [1, 1, 1], "o")
    axes.set_xticks([1, 4], ["1", "4"])
    assert [text.split(" ")[0] for text in texts(drawing)] == ["1", "3", "4"]


def test_the_table_has_a_row_a_mark_and_no_empty_column(panel):
    drawing, axes = panel
    axes.plot([1, 2], [0.5, 0.6], "o", label="kNN")
    axes.set(xlabel="share", ylabel="share")
    drawing.draw_without_rendering()
    frame = table(marks(drawing))
    assert list(frame) == ["series", "share (across)", "share"]
    assert frame.to_numpy().tolist() == [["kNN", "1", "0.500"], ["kNN", "2", "0.600"]]


@pytest.fixture
def drawing():
    """A chart of many series."""
    figure, axes = plt.subplots(figsize=(6, 4))
    for height, colour in enumerate(CYCLE):
        axes.plot([0, 1], [height, 1.3 * height], "o-", color=colour, label=f"series <{height}>")
    axes.set(xlabel="cost & time", title="a chart")
    axes.legend()
    yield figure
    plt.close(figure)


def test_every_series_keeps_its_exact_colour_and_words_stay_words(drawing):
    text = vector(drawing, "chart", 'what "it" shows')[0]
    assert {colour.lower() for colour in CYCLE} <= set(re.findall(r"var\(--[\w-]+, (#\w{6})\)", text))
    assert not re.findall(r"(?<!, )#[0-9a-f]{6}\b", text)  # no colour that a dark page could not set
    assert re.search(r"<text[^>]*>cost &amp; time</text>", text)
    assert "<title>a chart · series &lt;3&gt; · cost &amp; time: 1" in text
    assert 'aria-label="what &quot;it&quot; shows"' in text


def test_black_marks_take_the_ink_of_the_page():
    assert re.search(r"^svg\.chart \{[^}]*fill: var\(--ink\)", part("site.css"), re.M)  # matplotlib writes no black


def test_every_mark_can_be_hovered_where_it_is_drawn(drawing):
    text, labels = vector(drawing, "chart", "alt")
    hits = re.findall(r'<circle cx="([\d.]+)" cy="([\d.]+)"', text)
    drawn = re.findall(r'<use [^>]*x="([\d.]+)" y="([\d.]+)"[^>]*0072b2', text)
    assert len(hits) == len(labels) == 2 * len(CYCLE)
    hits, drawn = (np.array(places, dtype=float) for places in (hits, drawn))
    for place in drawn[:2]:  # of the first series, whose third is in the legend
        assert np.abs(hits - place).max(axis=1).min() < 0.1


@pytest.mark.slow
def test_two_charts_on_a_page_share_no_id_and_equal_charts_give_equal_bytes(drawing):
    texts = [vector(drawing, *words)[0] for words in (("one", "a"), ("other", "a"), ("one", "a"), ("one", "b"))]
    assert texts[0] == texts[2] and "metadata" not in texts[0] and "xml" not in texts[0]  # no date
    ids = [set(re.findall(r' id="([^"]+)"', text)) for text in texts]
    assert ids[0] and not ids[0] & ids[1] and not ids[0] & ids[3]
    for text, expected in zip(texts, ids, strict=True):
        assert set(re.findall(r'(?:href="|url\()#([^")]+)', text)) == expected


@pytest.mark.slow
def test_too_many_marks_are_left_to_the_table(drawing):
    for k in range(MOST_PATHS // 100 + 1):
        drawing.axes[0].plot(np.linspace(0, 1, 100), np.full(100, 1 + k / 10), "o")
    text, labels = vector(drawing, "chart", "alt")
    assert len(labels) > MOST_PATHS and "<circle" not in text


def test_a_drawing_with_a_picture_is_no_chart(drawing):
    assert has_marks_alone(drawing)
    drawing.axes[0].imshow(np.zeros((2, 2)))
    assert not has_marks_alone(drawing)
    assert not has_marks_alone(Drawing())
