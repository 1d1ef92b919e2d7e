"""The report as a whole: its files and its pages, also as a browser and axe-core see them."""

import json
import os
import re
import sys
from html import unescape
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import parse_qsl

import pandas as pd
import pytest
import yaml
from PIL import Image

from haptic_glance.base.files import write_table, write_text
from stages.charts import items
from stages.charts.commands import command
from stages.charts.drawing import save
from stages.charts.items import MOST_COLUMNS
from stages.charts.results import NotRun
from stages.compose import compose
from stages.engine import statistics
from stages.engine.settings import load_params
from stages.report.__main__ import write_report
from stages.report.claims import load
from stages.report.topics import TOPICS

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
OLD, OTHERS = "tables/gone.csv", "bench/pipeline.csv"  # results of an earlier run, and of what is no report
OLD_PAGE = "site/gone.html"
RESAMPLES = statistics.RESAMPLES  # before `few_pixels_and_resamples` lowers it
ODD = "<b>&qem</b>"
DRAWN = {"figure_3_3", "figure_3_6", "figure_3_10", "figure_3_12", "figure_3_13", "views_seen",
         "table_4_1", "touch_one_mesh"}  # fmt: skip
MOST_INTERVALS = 5  # in the prose of a page
REPEATED = """document.querySelectorAll('tbody tr:nth-child(n+9), .claims > li:nth-child(n+9)')
  .forEach(item => item.remove())"""  # rows and claims that are made as those before, which take axe a minute
WATCHED = []  # lists that take the paths opened while they stand here; an audit hook cannot be taken back


def note(event, arguments):
    if event == "open" and WATCHED and isinstance(arguments[0], str | Path):
        WATCHED[-1].append(Path(arguments[0]))


sys.addaudithook(note)


@pytest.fixture(scope="module")
def run(tmp_path_factory, small):
    """A small run with a report: its `root`, the `opened` files and the text of its `pages` by path.

    A method has an odd name, and rows on human gaze are of a set that is switched off.
    """
    root, opened = small.make_root(tmp_path_factory.mktemp("run")), []
    small.write_attention(root)
    for name in (OLD, OLD_PAGE, OTHERS):
        write_text(root / "reports" / name, "old")
    small.write_measurements(root, "lod", pd.concat([small.lod(), small.lod().assign(method=ODD)]))
    WATCHED.append(opened)
    write_report(small.read_results(root))
    WATCHED.pop()
    paths = [root / "reports/index.html", *sorted((root / "reports/site").glob("*.html"))]
    return SimpleNamespace(root=root, opened=opened, pages={path: path.read_text() for path in paths})


@pytest.fixture(scope="module")
def of_folder(tmp_path_factory, small):
    """The results of a run on a folder of one's own, with its report, as other processes write it."""
    root = small.make_root(tmp_path_factory.mktemp("own"))
    small.write_measurements(root, "lod", small.lod(), "elsewhere")
    write_table(root / "data/test/meshes/manifest.csv", pd.DataFrame({"object": ["ball", "cube"], "up": ["y", "-x"]}))
    results = small.own_results(root, "my meshes")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(statistics, "RESAMPLES", RESAMPLES)
        patch.setattr(items, "save", save)
        write_report(results)
        yield results


def test_figures_of_what_was_measured_are_drawn_and_say_what_they_show(run):
    assert {path.stem for path in (run.root / "reports/figures").glob("*.png")} >= DRAWN
    text = " ".join(run.pages.values())
    assert "3 for the median object" in text  # the fewest views
    assert re.search(r'alt="[^"]*with numbered places', text)


def test_dvc_knows_every_file_that_the_report_opens(run):
    listed = yaml.safe_load((ROOT / "dvc.yaml").read_text())["stages"]["report"]["deps"]
    listed = [dep.replace("${out}", "reports") for dep in listed]
    opened = {path.relative_to(run.root) for path in run.opened if path.is_relative_to(run.root)}
    inputs = {path for path in opened if path.parts[:1] == ("data",) or path.parts[:2] == ("reports", "measurements")}
    stages = {path.parts[2] for path in inputs if path.parts[0] == "data"}
    assert stages >= {"meshes", "classification", "lod", "weights"}
    assert Path("reports/measurements/gaze/weights.csv.gz") in inputs
    assert Path("data/reference/thesis") in {path.parent for path in inputs}
    assert not {str(path) for path in inputs if not any(path.is_relative_to(dep) for dep in listed)}


def test_old_results_go_and_those_of_others_and_of_sets_that_are_off_stay(run):
    assert not (run.root / "reports" / OLD).exists() and not (run.root / "reports" / OLD_PAGE).exists()
    assert (run.root / "reports" / OTHERS).exists() and len(run.pages) > 3


def test_a_page_has_few_findings_few_intervals_in_prose_and_no_wide_table(run):
    for path, text in run.pages.items():
        if path.stem == "claims":
            continue
        assert text.count("<li>", text.find('class="found"'), text.find("</ul>", text.find('class="found"'))) <= 3
        prose = re.sub(r"<(style|script|table)\b.*?</\1>|<[^>]+>", " ", text, flags=re.DOTALL)
        assert len(re.findall(r"\[[-−<> \d.,]+\]", prose)) <= MOST_INTERVALS, path.name
        for table in re.findall(r"<table>.*?</table>", text, flags=re.DOTALL):
            assert table.count("<th ", 0, table.find("</tr>")) <= MOST_COLUMNS, path.name


def test_a_page_begins_with_its_picture_and_shows_its_first_table_before_what_is_folded(run):
    for name, topic in TOPICS.items():
        text = run.pages.get(run.root / f"reports/site/{name}.html", "")
        drawn = [item.replace("/", "-") for item in topic.pictures if f'id="{item.replace("/", "-")}"' in text]
        if drawn:
            assert text.find("<section id=") == text.find(f'<section id="{drawn[0]}"')
        if 'class="item"' in text and "<h2>Tables and charts</h2>" in text:
            assert text.find("<h2>Tables and charts</h2>") < text.find('class="item"')


def test_pages_ask_nothing_of_the_network_and_are_accessible(run):
    for text in run.pages.values():
        assert not re.findall(r'(?:src|href)="(?!data:image/)[a-z]+:[^"]*"', text)
        assert "@import" not in text and not re.findall(r"url\((?!#)", text)
        assert '<html lang="en">' in text
        assert all(re.search(r'alt="[^"]{20,}"', image) for image in re.findall(r"<img[^>]*>", text))
        assert all(re.search(r'aria-label="[^"]{20,}"', chart) for chart in re.findall(r"<svg[^>]*chart[^>]*>", text))
        ids = re.findall(r'<[^>]* id="([^"]+)"', text)
        assert len(ids) == len(set(ids))
        levels = [int(level) for level in re.findall(r"<h(\d)", text)]
        assert levels[0] == 1 and levels.count(1) == 1


def test_links_lead_to_files_and_places_and_every_page_to_every_other(run):
    for path, text in run.pages.items():
        for link in re.findall(r'href="([^"]+)"', re.sub(r"<svg.*?</svg>", "", text, flags=re.DOTALL)):
            name, _, place = link.partition("#")
            target = (path.parent / name).resolve() if name else path
            assert target.exists(), link
            if "=" in place:  # filters of the claims
                wanted = [value for _, value in parse_qsl(unescape(place))]
                assert all(f'<option value="{value}"' in target.read_text() for value in wanted), link
            else:
                assert not place or f'id="{place}"' in target.read_text(), link
        nav = re.search(r'<nav aria-label="Pages">(.*?)</nav>', text)[1]
        reached = {(path.parent / link).resolve() for link in re.findall(r'href="([^"]+)"', nav)}
        assert reached == {page for page in run.pages if page.stem != "claims"}
        assert nav.count('aria-current="page"') == (path.stem != "claims")


def test_names_are_escaped(run):
    assert not any(ODD in text for text in run.pages.values())
    assert any("&lt;b&gt;&amp;qem&lt;/b&gt;" in text for text in run.pages.values())


def test_nothing_measured_is_listed_and_no_error(bare, small, capsys):
    write_report(small.read_results(bare))
    printed = capsys.readouterr().out
    start = "report: not run, no measurements of classification"
    lines = [line for line in printed.splitlines() if line.startswith(start)]
    assert len(lines) == 1 and "`dvc repro classification`: tables/table_4_1, " in lines[0]
    text = (bare / "reports/index.html").read_text()
    assert "<p>not run: no data/SET/salient_points: run <code>dvc repro" in text and "no data/SET/meshes" in text


def test_items_that_lack_their_data_alone_stay(bare, small, capsys):
    reports = bare / "reports"
    stays, goes = ("figures/figure_3_10.png", "tables/dataset.csv"), ("figures/no_name.png", "tables/table_4_1.csv")
    for name in (*stays, *goes):
        write_text(reports / name, "drawn")
    Image.new("RGB", (4, 4)).save(reports / stays[0])
    write_report(small.read_results(bare))
    assert [(reports / name).exists() for name in (*stays, *goes)] == [True, True, False, False]
    (line,) = (line for line in capsys.readouterr().out.splitlines() if "figure_3_10" in line)
    assert 'id="figures-figure_3_10"' in (reports / "site/look.html").read_text()
    assert "tables/dataset (meshes)" in line and "figures/figure_3_10 (conspicuity)" in line and "no_name" not in line


def test_a_folder_of_ones_own_has_a_page_about_it_alone(of_folder):
    assert of_folder.own_meshes and of_folder.datasets("lod") == ["test"]
    with pytest.raises(NotRun, match="not switched on"):
        of_folder.rows("lod", "elsewhere")
    page = (of_folder.reports / "index.html").read_text()
    assert "Your meshes" in page and all(f"<h2>{name}</h2>" in page for name in of_folder.objects)
    assert all((of_folder.reports / address).exists() for address in re.findall(r'href="(site/[^"]+)"', page))
    assert json.loads((of_folder.reports / "metrics/report.json").read_text())["not_run"] > 1  # the note, and reasons
    assert "y is up in the file." in page and "-x is up in the file." in page
    assert "haptic-glance gallery &#x27;my meshes&#x27;" in page
    assert "units of the object&#x27;s diameter" in page and "Touched there" in page
    assert pd.read_csv(of_folder.reports / "claims.csv")["pairs"].gt(0).all()


def test_equal_runs_give_equal_bytes_with_any_number_of_workers(of_folder, small):
    files = sorted(path for path in of_folder.reports.rglob("*") if path.is_file())
    before = [path.read_bytes() for path in files]
    params = of_folder.workspace.root / "params.yaml"
    params.write_text(params.read_text().replace("backend: sequential", "backend: loky, workers: 2"))
    write_report(small.read_results(of_folder.workspace.root))
    assert [path.read_bytes() for path in files] == before


def axe():
    """The file of axe-core, or None."""
    places = [os.environ.get("NODE_PATH"), "node_modules", str(Path.home() / "node_modules")]
    files = (Path(place) / "axe-core/axe.min.js" for place in places if place)
    return next((path for path in files if path.exists()), None)


def test_claims_filter_and_open_to_their_readings(tab, run):
    site = run.root / "reports"
    claims = pd.read_csv(site / "claims.csv").fillna({"size": ""})
    address = (site / "site/claims.html").as_uri()
    tab.goto(address)
    shown = tab.locator("#list li:visible")
    assert shown.count() == 0 and f"{len(claims)} of {len(claims)} claims" in tab.locator("#found").inner_text()
    tab.get_by_label("Verdict").select_option("supported")
    assert shown.count() == (claims["verdict"] == "supported").sum() > 0  # their chapters open
    tab.get_by_label("Beside the printed number").select_option("smaller")
    both = (claims["verdict"] == "supported") & (claims["size"] == "smaller")
    assert shown.count() == both.sum()
    tab.goto("about:blank")
    tab.goto(f"{address}#verdict=open")
    assert shown.count() == (claims["verdict"] == "open").sum() > 0
    key = claims.loc[claims["verdict"] == "supported", "key"].iloc[0]
    tab.goto("about:blank")
    tab.goto(f"{address}#{key}")
    assert f"python -m stages.claim {key}" in tab.locator(f"#{key} dl").inner_text()


@pytest.mark.parametrize(("scheme", "width"), [("light", 1280), ("dark", 390)])
def test_pages_fit_their_width_and_axe_finds_nothing(browser, run, width, scheme):
    if axe() is None:
        pytest.skip("no axe-core: `npm install axe-core@4.10.3`")
    for path in run.pages:
        tab = browser.new_page(viewport={"width": width, "height": 800}, color_scheme=scheme)
        tab.goto(path.as_uri())
        assert tab.evaluate("document.documentElement.scrollWidth") <= width, path.name
        tab.evaluate(REPEATED)
        tab.evaluate(axe().read_text(encoding="utf-8"))
        violations = tab.evaluate("axe.run({resultTypes: ['violations']})")["violations"]
        bad = [(entry["id"], entry["nodes"][0]["html"]) for entry in violations]
        tab.close()
        assert not bad, path.name


def test_the_command_of_a_claim_switches_its_stage_on():
    switched = {}
    needs = {(claim.stage, tuple(dict.fromkeys(name for _, name in claim.files()))) for claim in load()}
    assert len(needs) > 10
    for stage, sets in sorted(needs):
        text = command(ROOT / "conf", stage, sets)
        steps = re.findall(r"python -m stages\.compose ?'?([^' ]*)'? && dvc repro ([^&]+)", text)
        targets = {override: {*repeated.split()} - {"report"} for override, repeated in steps}
        assert set().union(*targets.values()) == {f"{stage}@{name}" for name in sets}, (stage, sets)
        for override, names in targets.items():
            switched.setdefault(override, set()).update(names)
    chosen = {"": load_params(ROOT / "params.yaml")}  # which tests/test_compose.py holds against what is composed
    for start in ("experiment=", "sets="):
        fewest = min(
            (option for option in switched if option.startswith(start)), key=lambda option: len(switched[option])
        )
        chosen[fewest] = compose([fewest])
    for override, values in chosen.items():
        graph = values["graph"]
        assert all(name.partition("@")[2] in graph[name.partition("@")[0]] for name in switched[override]), override
