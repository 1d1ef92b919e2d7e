"""Parts of the pages: tables and charts with their numbers; some of them in a browser."""

from pathlib import Path

import pandas as pd
import pytest

from stages.charts.html import frame_html, item_html, prose
from stages.charts.items import Table
from stages.charts.tables import Ranking
from stages.report.parts import KINDS, PARTS, Built
from stages.report.site import MENU, front_main, page_html
from stages.report.topics import TOPICS


def show(tab, tmp_path, main):
    """Opens a page of the site with this text."""
    (tmp_path / "page.html").write_text(page_html({}, "", "Page", "", main, ["site.js"]), encoding="utf-8")
    tab.goto((tmp_path / "page.html").as_uri())


def column(tab, number):
    """The visible cells of a column."""
    return tab.locator(f"tbody tr:visible td:nth-child({number})").all_inner_texts()


def test_the_summary_stands_over_a_table_and_the_notes_are_folded():
    notes, paths = ["first `x`", "second"], [Path("tables/t.csv")]
    text = item_html(Table(pd.DataFrame({"x": [1]}), notes=notes, paths=paths, summary="Found: `1`."))
    assert prose("`a<b` and ` alone") == "<code>a&lt;b</code> and ` alone"
    shown, _, hidden = text.partition("<details>")
    assert shown.index("Found: <code>1</code>.") < shown.index("<table>") and "first" not in shown
    assert "first <code>x</code>" in hidden and "second" in hidden


def test_columns_that_do_not_answer_the_question_can_be_unfolded():
    frame = pd.DataFrame({"name": ["a", "b"], "score": [1, 2], "detail": [3, 4]})
    table = Table(frame, paths=[Path("tables/t.csv")], best=Ranking("score"), answer=["name", "score"])
    shown, _, hidden = item_html(table).partition("<details>")
    assert "detail" not in shown and "further columns" in hidden and "detail" in hidden
    assert '<td class="number"><b>2</b></td>' in shown and shown.count("<b>") == 1
    assert "Bold: the highest in the column “score”." in shown


@pytest.mark.slow
def test_a_click_on_a_head_sorts_by_number_both_ways_and_gaps_stay_below(tab, tmp_path):
    values = ["9", "–", "1,000 [900, 1,100]", "+12.5", "-3", "> 45"]
    show(tab, tmp_path, frame_html(pd.DataFrame({"name": list("abcdef"), "value": values}), "Values"))
    tab.get_by_role("button", name="value").click()
    assert column(tab, 1) == ["e", "a", "d", "f", "c", "b"]
    assert tab.locator("th").nth(1).get_attribute("aria-sort") == "ascending"
    tab.get_by_role("button", name="value").press("Enter")
    assert column(tab, 1) == ["c", "f", "d", "a", "e", "b"]
    tab.get_by_role("button", name="name").click()
    assert column(tab, 1) == list("abcdef")
    assert tab.locator("th[aria-sort]").count() == 1


@pytest.mark.parametrize(("cell", "whole"), [("not run · 3", False), ("3", True)])
def test_a_table_with_gaps_is_listed_among_what_was_not_run(cell, whole, small, bare):
    table = Table(pd.DataFrame({"x": [cell]}), name="gaps", kind="tables", page="none", paths=[Path("tables/t.csv")])
    page = front_main(small.read_results(bare), Built([table]), {}, None, {}, bare / "reports")
    assert ("Everything that this report knows was measured" in page) == whole
    assert ("<code>tables/gaps</code>: in part" in page) != whole


def test_topics_name_items_that_exist_and_each_once_and_are_in_the_menu():
    made = {f"{kind}/{name}" for part in PARTS.values() for kind, held in KINDS.items() for name in getattr(part, held)}
    placed = [item for topic in TOPICS.values() for item in (*topic.shown, *topic.folded)]
    assert len(placed) == len(set(placed)) and {*placed} <= made
    assert {picture for topic in TOPICS.values() for picture in topic.pictures} <= made
    assert {part.PAGE for part in PARTS.values()} <= {*MENU} and {*TOPICS, "thesis"} == {*MENU}
