"""The site in a browser: tables sort and filter, charts can be read, claims open; and what axe-core says."""

import os
import re
from functools import cache
from pathlib import Path

import pandas as pd
import pytest
from matplotlib.figure import Figure as Drawing

from stages.compose import compose
from stages.report.__main__ import write_report
from stages.report.claims_page import sets_read
from stages.report.items import Figure, Table
from stages.report.page import frame_html, item_html
from stages.report.records import command
from stages.report.site import page
from stages.report.tables import Ranking
from stages.report.topics import CLAIMS

CONF = Path(__file__).parents[2] / "conf"
SERIOUS = ("serious", "critical")


def axe():
    """The file of axe-core, or None."""
    places = [os.environ.get("NODE_PATH"), "node_modules", str(Path.home() / "node_modules")]
    found = (Path(place) / "axe-core/axe.min.js" for place in places if place)
    return next((path for path in found if path.exists()), None)


@pytest.fixture
def tab(browser):
    """A page of the browser that fails the test where a script does."""
    opened, faults = browser.new_page(viewport={"width": 1280, "height": 800}), []
    opened.on("pageerror", lambda error: faults.append(str(error)))
    yield opened
    opened.close()
    assert not faults


def show(tab, tmp_path, main):
    """Opens a page of the site with this text."""
    (tmp_path / "page.html").write_text(page([], "", "", main, ["site.js"]), encoding="utf-8")
    tab.goto((tmp_path / "page.html").as_uri())


def column(tab, number):
    """The visible cells of a column."""
    return tab.locator(f"tbody tr:visible td:nth-child({number})").all_inner_texts()


def chart(tmp_path):
    """A figure of three points with one interval, written and with its words."""
    drawing = Drawing()
    axes = drawing.subplots()
    axes.plot([1, 2, 3], [0.1, 0.2, 0.3], "o-", label="kNN")
    axes.plot([2, 2], [0.15, 0.25])
    item = Figure(drawing, name="chart", title="A chart", alt="What it shows to all", caption="See `this`.")
    item.write(tmp_path / "figures")
    return item


def test_a_chart_has_its_numbers_behind_it(tmp_path):
    text = item_html(chart(tmp_path))
    assert "<svg" in text and "<img" not in text
    assert text.count("<tr><td") == 3 and "<td>[0.150, 0.250]</td>" in text.replace(' class="number"', "")


def test_the_summary_stands_over_a_table_and_the_notes_are_folded():
    notes, paths = ["first `x`", "second"], [Path("tables/t.csv")]
    text = item_html(Table(pd.DataFrame({"x": [1]}), notes=notes, paths=paths, summary="Found: `1`."))
    shown, _, hidden = text.partition("<details>")
    assert shown.index("Found: <code>1</code>.") < shown.index("<table>") and "first" not in shown
    assert "first <code>x</code>" in hidden and "second" in hidden


def test_columns_that_do_not_answer_the_question_can_be_unfolded():
    frame = pd.DataFrame({"name": ["a", "b"], "score": [1, 2], "detail": [3, 4]})
    table = Table(frame, paths=[Path("tables/t.csv")], best=Ranking("score"), answer=["name", "score"])
    shown, _, hidden = item_html(table).partition("<details>")
    assert "detail" not in shown and "All 3 columns" in hidden and "detail" in hidden
    assert '<tr class="best"><td>b</td>' in shown and shown.count('class="best"') == hidden.count('class="best"') == 1


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


@pytest.mark.slow
def test_a_filter_shows_the_rows_that_hold_all_words(tab, tmp_path):
    frame = pd.DataFrame(
        {"name": [f"row {k}" for k in range(10)], "kind": ["odd" if k % 2 else "even" for k in range(10)]}
    )
    show(tab, tmp_path, frame_html(frame, "Rows"))
    tab.get_by_label("Filter").fill("ODD row 3")
    assert column(tab, 1) == ["row 3"]
    assert "1 of 10 rows" in tab.locator(".filter").inner_text()
    tab.get_by_label("Filter").fill("")
    assert len(column(tab, 1)) == 10


@pytest.mark.slow
def test_a_chart_tells_its_values_to_pointer_and_keyboard(tab, tmp_path):
    show(tab, tmp_path, item_html(chart(tmp_path)))
    tab.locator(".hits circle").nth(1).hover()
    assert tab.locator("#tip").inner_text() == "kNN · 2 · 0.200 [0.150, 0.250]"
    tab.mouse.move(0, 0)
    assert tab.locator("#tip").is_hidden()
    box = tab.locator(".wide")
    for key, value in (
        ("ArrowRight", "0.100"),
        ("ArrowRight", "0.200"),
        ("ArrowLeft", "0.100"),
        ("ArrowLeft", "0.300"),
    ):
        box.press(key)
        assert value in tab.locator("#tip").inner_text()
    box.press("Escape")
    assert tab.locator("#tip").is_hidden()


@pytest.fixture(scope="module")
def site(tmp_path_factory, small):
    """The reports of a small run."""
    root = small.root(tmp_path_factory.mktemp("site"))
    small.write(root, "lod", small.lod())
    write_report(small.results(root))
    return root / "reports"


@pytest.mark.slow
def test_claims_filter_and_open_to_their_pairs(tab, site):
    claims = pd.read_csv(site / "claims.csv")
    differences = pd.read_csv(site / "claims/differences.csv.gz")
    tab.goto((site / "site/claims.html").as_uri())
    shown = tab.locator("#list > li:visible")
    assert shown.count() == len(claims)
    tab.get_by_label("Verdict").select_option("supported")
    assert shown.count() == (claims["verdict"] == "supported").sum() > 0
    tab.get_by_label("Chapter").select_option("ours")
    both = claims[(claims["verdict"] == "supported") & (claims["section"] == "ours")]
    assert shown.count() == len(both) > 0
    assert f"{len(both)} of {len(claims)} claims" in tab.locator("#found").inner_text()
    key = both["key"].iloc[0]
    tab.goto("about:blank")
    tab.goto(f"{(site / 'site/claims.html').as_uri()}#{key}")
    assert tab.locator(f"#{key} tbody tr").count() == (differences["key"] == key).sum() > 0
    said = tab.locator(f"#{key} dl").inner_text()
    assert "dvc repro" in said and f"python -m stages.claim {key}" in said


@pytest.mark.slow
@pytest.mark.parametrize(("scheme", "width"), [("light", 1280), ("dark", 390)])
def test_pages_fit_their_width_and_axe_finds_nothing_serious(browser, site, width, scheme):
    if axe() is None:
        pytest.skip("no axe-core: `npm install axe-core@4.10.3`")
    for path in [site / "index.html", *sorted((site / "site").glob("*.html"))]:
        tab = browser.new_page(viewport={"width": width, "height": 800}, color_scheme=scheme)
        tab.goto(path.as_uri())
        assert tab.evaluate("document.documentElement.scrollWidth") <= width, path.name
        tab.evaluate(axe().read_text(encoding="utf-8"))
        found = tab.evaluate("axe.run()")["violations"]
        bad = [(one["id"], one["nodes"][0]["html"]) for one in found if one["impact"] in SERIOUS]
        tab.close()
        assert not bad, path.name


@pytest.mark.slow
def test_the_command_of_a_claim_switches_its_stage_on(small):
    results = small.results(Path(__file__).parents[2])
    asked = {(claim.stage, tuple(sets_read(claim, results))) for claim in CLAIMS}
    assert len(asked) > 10
    graphs = cache(lambda override: compose([override] if override else [])["graph"])
    for stage, sets in asked:
        steps = re.findall(r"python -m stages\.compose ?'?([^' ]*)'? && dvc repro ([^&]+)", command(CONF, stage, sets))
        found = [name for override, repeated in steps for name in repeated.split() if name != "report"
                 if name.partition("@")[2] in graphs(override)[stage]]  # fmt: skip
        assert sorted(found) == sorted(f"{stage}@{name}" for name in sets), (stage, sets)
