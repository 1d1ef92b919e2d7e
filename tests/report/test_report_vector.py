"""Charts as SVG: exact colours, marks where they are drawn, ids that no other chart has, equal bytes."""

import re

import numpy as np
import pytest
from matplotlib.figure import Figure as Drawing

from stages.report.drawing import CYCLE, plt
from stages.report.marks import MOST_PATHS, has_marks_alone, vector


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


def test_every_series_keeps_its_exact_colour(drawing):
    text = vector(drawing, "chart", "alt")[0]
    assert {colour.lower() for colour in CYCLE} <= set(re.findall(r"var\(--[\w-]+, (#\w{6})\)", text))
    assert not re.findall(r"(?<!, )#[0-9a-f]{6}\b", text)  # no colour that a dark page could not set


def test_every_mark_can_be_hovered_where_it_is_drawn(drawing):
    text, found = vector(drawing, "chart", "alt")
    hits = re.findall(r'<circle cx="([\d.]+)" cy="([\d.]+)"', text)
    drawn = re.findall(r'<use [^>]*x="([\d.]+)" y="([\d.]+)"[^>]*0072b2', text)
    assert len(hits) == len(found) == 2 * len(CYCLE)
    hits, drawn = (np.array(places, dtype=float) for places in (hits, drawn))
    for place in drawn[:2]:  # of the first series, whose third is in the legend
        assert np.abs(hits - place).max(axis=1).min() < 0.1


def test_words_stay_words_and_are_escaped(drawing):
    text = vector(drawing, "chart", 'what "it" shows')[0]
    assert re.search(r"<text[^>]*>cost &amp; time</text>", text)
    assert "<title>a chart · series &lt;3&gt; · cost &amp; time: 1" in text
    assert 'aria-label="what &quot;it&quot; shows"' in text


def test_two_charts_on_a_page_share_no_id_and_all_references_are_kept(drawing):
    texts = [vector(drawing, name, "alt")[0] for name in ("one", "other")]
    ids = [set(re.findall(r' id="([^"]+)"', text)) for text in texts]
    assert ids[0] and not ids[0] & ids[1]
    for text, own in zip(texts, ids, strict=True):
        assert set(re.findall(r'(?:href="|url\()#([^")]+)', text)) == own


def test_equal_charts_give_equal_bytes_without_a_date(drawing):
    text = vector(drawing, "chart", "alt")[0]
    assert text == vector(drawing, "chart", "alt")[0]
    assert "metadata" not in text and "xml" not in text


def test_too_many_marks_are_left_to_the_table(drawing):
    for k in range(MOST_PATHS // 100 + 1):
        drawing.axes[0].plot(np.linspace(0, 1, 100), np.full(100, 1 + k / 10), "o")
    text, found = vector(drawing, "chart", "alt")
    assert len(found) > MOST_PATHS and "<circle" not in text


def test_a_drawing_with_a_picture_is_no_chart(drawing):
    assert has_marks_alone(drawing)
    drawing.axes[0].imshow(np.zeros((2, 2)))
    assert not has_marks_alone(drawing)
    assert not has_marks_alone(Drawing())
