"""The pages: a front page with findings and questions, and a page a topic below reports/site. All work offline."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from html import escape
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any

import pandas as pd

from haptic_glance.base.files import write_text
from haptic_glance.gallery import viewer
from haptic_glance.gallery.viewer import as_script
from stages.charts.cells import CLAIMS as CLAIM_ROWS
from stages.charts.cells import PREFIXES, filled
from stages.charts.datasets import dataset_text
from stages.charts.html import box, folded, image, lacks_cells, prose
from stages.charts.items import Figure, Table, findings
from stages.charts.results import NotRun, Results
from stages.charts.tables import with_interval

from .claims import load
from .claims_page import claims_main
from .parts import PARTS, Built, page_of
from .verdict import DEPENDS, UNTESTABLE, counts, of_thesis


@dataclass(frozen=True)
class Finding:
    """A claim that the front page shows.

    verdict: the verdict for which the title is right; with any other verdict, the card shows the claim's own sentence.
    shown: a key of PREFIXES, the shown form of its effect. unit: of what is shown, with its direction.
    """

    key: str
    verdict: str
    title: str
    unit: str
    page: str
    shown: str = ""
    places: int = 0


FINDINGS = (
    Finding("glance_over_best_gaze", "supported", "Our glance predicts where people look better than any rival",
            "NSS more than the best other", "attention", places=2),
    Finding("glance_soft_gaze", "supported", "Saliency as a weight keeps meshes closer where people looked",
            "% less error where people looked", "meshes", "less:", 1),
    Finding("glance_over_blind", "supported", "Touch where our glance points beats blind touch",
            "points of accuracy more than blind touch", "touch"),
    Finding("keep_metro", "contradicted", "Fails: neighbourhoods kept unchanged raise the error",
            "times the error of plain simplification", "meshes", "times:", 2),
    Finding("simulation_helps_5", "contradicted", "Fails: imprints of a simulated skin make real touch harder to tell",
            "points of accuracy more than without them", "recorded"),
)  # fmt: skip
UNCLEAR = """<li><h3>Most sentences of the thesis are not that clear</h3><p>Of {count} sentences of the thesis,
<strong>{supported}</strong> are supported and <strong>{contradicted}</strong> contradicted. {untestable} cannot be
tested or depend on how the protocol is read; the others are open,
mixed or show no difference. Each opens to its pairs, data and command.</p>
<p><a href="site/claims.html">All claims</a></p></li>"""
ANSWER = '<li><h3>{asked}</h3><p>{answer} <a href="{address}">{kind}</a></p></li>'
HOME, FOLDER = "index.html", "site"
CHARTS = ("touch", "attention")  # the chart of the front page: the first of these that was drawn
FIRST = "pipeline"  # the picture of the front page
WIDE = 1700  # pixels of it
LEAD = "Look at an object, touch only the places that matter, and know what it is."
INTRODUCTION = """A person glances at an object, knows which few places matter, touches only those, and knows what it
is. Haptic Glance does the same for 3D meshes: it predicts where people look, keeps the mesh fine there, presses a
virtual pressure array there, and recognises the object. It tests every claim of a thesis on the way, and says which
fail."""


def write_site(
    results: Results, built: Built, not_run: dict[str, str], claims: tuple[pd.DataFrame, pd.DataFrame],
    meshes: dict[str, Any] | None, out: Path,
) -> list[str]:  # fmt: skip
    """Writes OUT/index.html and OUT/site/*.html, and removes older pages; returns the names of the pages of the site.

    not_run: {KIND/NAME: why} of what lacks its measurement. claims: the frames of verdict.tabled. meshes: those that
    can be turned.
    """
    frame, differences = claims
    leads: dict[str, str] = {}
    for part in PARTS.values():
        leads.setdefault(page_of(part), (part.__doc__ or "").strip())
    mains = {page: main for page in leads if (main := page_main(page, results, built, out))}
    if len(frame):
        mains[CLAIM_ROWS] = claims_main(load(), frame, differences, results)
    leads[CLAIM_ROWS] = "Each sentence of the thesis, and of this project about its own model, has its verdict here."
    for name, main in mains.items():
        scripts = ["site.js", "claims.js"] if name == CLAIM_ROWS else ["site.js"]
        write_text(out / FOLDER / f"{name}.html", page_html(list(mains), name, leads[name], main, scripts))
    for path in set((out / FOLDER).glob("*.html")) - {out / FOLDER / f"{name}.html" for name in mains}:
        path.unlink()
    main = front_main(results, built, not_run, frame, meshes, {name: leads[name] for name in mains}, out)
    write_text(out / HOME, page_html(list(mains), "", LEAD, main, ["viewer.js", "site.js"]))
    return list(mains)


def page_html(names: Sequence[str], name: str, lead: str, main: str, scripts: Sequence[str]) -> str:
    """A whole page; names: of all pages but the front page, which has none itself."""
    up, down = ("../", "") if name else ("", f"{FOLDER}/")
    addresses = {f"{up}{HOME}": "Haptic Glance"} | {f"{down}{page}.html": page.capitalize() for page in names}
    current = f"{name}.html" if name else HOME
    mark = {current: ' aria-current="page"'}
    links = (f'<a href="{address}"{mark.get(address, "")}>{text}</a>' for address, text in addresses.items())
    words = {
        "style": page_file("page.css") + page_file("site.css"),
        "title": f"{name.capitalize()} · Haptic Glance" if name else "Haptic Glance: results",
        "nav": " ".join(links),
        "heading": name.capitalize() or "Haptic Glance",
        "lead": prose(lead),
        "main": main,
        "scripts": "\n".join(f"<script>\n{page_file(script)}</script>" for script in scripts),
    }
    return Template(page_file("page.html")).substitute(words)


def page_file(name: str) -> str:
    """A file of the folder page/, or of the library's viewer of meshes."""
    file = resources.files(__package__ or "") / "page" / name
    return file.read_text(encoding="utf-8") if file.is_file() else viewer.part(name)


def page_main(page: str, results: Results, built: Built, out: Path) -> str:
    """The findings of a page, its charts and tables; those of sets that are off come last.

    out: the folder whose tables, charts and claims are written already; the figures of what was found are theirs.
    """
    parts = [part for part in PARTS.values() if page_of(part) == page]
    items = [item for item in built.items if item.page == page]
    if not items:
        return ""
    paragraphs = [] if results.own_meshes else [text for part in parts for text in findings(part, out)]
    text = "".join(f"<p>{prose(paragraph)}</p>" for paragraph in paragraphs)
    text = f'<section id="found" class="found"><h2>What was found</h2>{text}</section>\n' if text else ""
    others = [item for item in items if item.sets and not set(item.sets) & set(results.sets)]
    ordered = [*charts_first([item for item in items if item not in others]), *charts_first(others)]
    contents = "".join(f'<li><a href="#{anchor(item)}">{escape(item.title)}</a></li>' for item in ordered)
    text += f'<nav aria-label="On this page" class="contents"><ul>{contents}</ul></nav>\n' if len(items) > 2 else ""
    text += "".join(item.html for item in ordered if item not in others)
    if others:
        sets = ", ".join(dict.fromkeys(dataset_text(name) for item in others for name in item.sets))
        text += f'<h2 id="others">Measured on other data sets</h2>\n<p>Not part of this run: {escape(sets)}.</p>\n'
        text += "".join(item.html for item in charts_first(others))
    return text


def charts_first(items: Sequence[Table | Figure]) -> list[Table | Figure]:
    """The items, charts and pictures before tables."""
    return sorted(items, key=lambda item: isinstance(item, Table))


def front_main(
    results: Results, built: Built, not_run: dict[str, str], claims: pd.DataFrame, meshes: dict[str, Any] | None,
    leads: Mapping[str, str], out: Path,
) -> str:  # fmt: skip
    """The text of the front page below its head."""
    by_name = {f"{item.kind}/{item.name}": item for item in built.items}
    picture = by_name.get(f"figures/{FIRST}")
    chart = next((item for item in built.items if item.kind == "tradeoff" and item.name in CHARTS), None)
    partly = {name: "in part, as its cells say" for name, item in by_name.items()
              if isinstance(item, Table) and lacks_cells(item)}  # fmt: skip
    reasons: dict[str, list[str]] = {}
    for name, reason in (not_run | partly).items():
        reasons.setdefault(reason, []).append(f"<code>{escape(name)}</code>")
    missing = "".join(f"<li>{', '.join(names)}: {prose(reason)}</li>" for reason, names in reasons.items())

    def address(source: str, where: str) -> str:
        if source == CLAIM_ROWS:
            return f"{FOLDER}/{CLAIM_ROWS}.html#{where.partition('=')[2]}"
        return f"{FOLDER}/{by_name[source].page}.html#{anchor(by_name[source])}"

    words = {
        "heading": "Your meshes" if results.own_meshes else "The pipeline on one object",
        "what": prose(" ".join(INTRODUCTION.split())),
        "dataset": prose(dataset_line(results)),
        "pictures": image(picture, WIDE) if isinstance(picture, Figure) else "",
        "findings": "" if results.own_meshes else findings_html(claims),
        "questions": "" if results.own_meshes else questions_html(out, address),
        "chart": chart_html(chart) if isinstance(chart, Figure) and not results.own_meshes else "",
        "viewer": page_file("viewer.html") if meshes else f"<p>not run: {prose(not_run.get('viewer', ''))}</p>",
        "meshes": as_script(meshes) if meshes else "null",
        "topics": "".join(
            f'<li><a href="{FOLDER}/{name}.html">{name.capitalize()}</a>: {prose(lead)}</li>'
            for name, lead in leads.items()
        ),
        "not_run": folded(f"{len(not_run | partly)} that were not, or in part", f"<ul>{missing}</ul>") if missing
        else "<p>Everything that this report knows was measured.</p>",
    }  # fmt: skip
    return Template(page_file("front.html")).substitute(words)


def findings_html(claims: pd.DataFrame) -> str:
    """The cards of those FINDINGS that were measured."""
    rows = {str(row.key): row for row in claims.dropna(subset=["low"]).itertuples()}
    cards = [card(finding, rows[finding.key]) for finding in FINDINGS if finding.key in rows]
    if not cards:
        return ""
    thesis = of_thesis(claims)
    tally = counts(thesis)
    unclear = UNCLEAR.format(count=len(thesis), untestable=tally[UNTESTABLE] + tally[DEPENDS], **tally)
    return f'<section id="findings"><h2>Five findings</h2><ul class="cards">{"".join(cards)}{unclear}</ul></section>\n'


def card(finding: Finding, row: Any) -> str:
    """One finding with its number, its interval and its links."""
    title = finding.title if row.verdict == finding.verdict else f"{row.claim} ({row.verdict})"
    mean, *ends = (PREFIXES[finding.shown](value) for value in (row.effect, row.low, row.high))
    figure = with_interval(mean, *sorted(ends), places=finding.places)
    signed = "+" if mean > 0 and finding.shown == "" else ""
    links = f'<a href="site/claims.html#{finding.key}">The claim</a>, '
    links += f'<a href="site/{finding.page}.html">{finding.page.capitalize()}</a>'
    return (
        f'<li><h3>{escape(title)}</h3><p class="figure"><strong>{signed}{figure}</strong> {escape(finding.unit)}</p>'
        f'<p class="help">{row.pairs} {escape(row.over)}, 95 % interval. {links}</p></li>'
    )


def questions_html(reports: Path, address: Callable[[str, str], str]) -> str:
    """The section of questions, each answered in a sentence with a link to its table; those that were not measured go.

    address: from the first source of an answer, (KIND/NAME or claims, which row), to the address of its table.
    """
    items = []
    for question, answer in re.findall(r"^# (.+)\n\n((?:.+\n?)+)", page_file("questions.md"), flags=re.MULTILINE):
        try:
            text, sources = filled(" ".join(answer.split()), reports)
        except LookupError:
            continue
        kind = "Claim" if sources[0][0] == CLAIM_ROWS else "Table"
        link = {"address": address(*sources[0]), "kind": kind}
        items.append(ANSWER.format(asked=escape(question), answer=prose(text), **link))
    body = f'<h2>What people ask</h2><ul class="cards two">{"".join(items)}</ul>'
    return f'<section id="questions">{body}</section>\n' if items else ""


def chart_html(chart: Figure) -> str:
    """The chart of the front page with its caption and a link to its page."""
    link = f'<a href="{FOLDER}/{chart.page}.html#{anchor(chart)}">Its numbers</a>'
    caption = f"<figcaption>{prose(chart.caption)} {link}</figcaption>"
    body = f'<figure class="beside">{box("wide", chart.title, image(chart))}{caption}</figure>'
    return f'<section id="chart"><h2>{escape(chart.title)}</h2>{body}</section>\n'


def anchor(item: Table | Figure) -> str:
    """The id of an item's section on its page."""
    return f"{item.kind}-{item.name}"


def dataset_line(results: Results) -> str:
    """How many objects of which data set, for the head of the page."""
    try:
        return f"{len(results.objects)} objects of the data set {results.folder('meshes').parent.name}"
    except NotRun:
        return "no objects yet"
