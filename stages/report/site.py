"""The pages: a front page, and a page a topic below reports/site. All work offline."""

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
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
from stages.charts.cells import filled
from stages.charts.html import folded, image, lacks_cells, prose
from stages.charts.items import Figure, Table
from stages.charts.results import NotRun, Results

from .claims import load
from .claims_page import claims_main
from .parts import Built
from .thesis_page import TITLE, thesis_frame, thesis_html
from .topics import TOPICS

HOME, FOLDER = "index.html", "site"
MENU = ("look", "simplify", "touch", "know", "thesis", "stability", "speed")
FIRST = "figures/pipeline"  # the picture of the front page
WIDE = 1700  # pixels of it
LEAD = "Look at an object, touch only the places that matter, and know what it is."
INTRODUCTION = """A person glances at an object, knows which few places matter, touches only those, and knows what it
is. Haptic Glance does the same for 3D meshes: it predicts where people look, keeps the mesh fine there, presses a
virtual pressure array there, and recognises the object. It tests every claim of a thesis on the way, and says which
fail."""


def write_site(
    results: Results, built: Built, not_run: dict[str, str], claims: pd.DataFrame, meshes: dict[str, Any] | None,
    out: Path,
) -> list[str]:  # fmt: skip
    """Writes OUT/index.html and OUT/site/*.html, and removes older pages; returns the names of the pages of the site.

    not_run: {KIND/NAME: why} of what lacks its measurement. claims: the frame of `verdict.judge`. meshes: those that
    can be turned.
    """
    mains = {name: main for name in TOPICS if (main := topic_main(name, results, built, out))}
    pages = {name: (TOPICS[name].title, TOPICS[name].lead, main) for name, main in mains.items()}
    pages |= {name: page for name, page in further_pages(built, claims, results.reports).items() if page[2]}
    titles = {name: pages[name][0] for name in MENU if name in pages}
    for name, (title, lead, main) in pages.items():
        scripts = ["site.js", "claims.js"] if name == CLAIM_ROWS else ["site.js"]
        write_text(out / FOLDER / f"{name}.html", page_html(titles, name, title, lead, main, scripts))
    for path in set((out / FOLDER).glob("*.html")) - {out / FOLDER / f"{name}.html" for name in pages}:
        path.unlink()
    main = front_main(results, built, not_run, meshes, {name: pages[name] for name in titles}, out)
    write_text(out / HOME, page_html(titles, "", "Haptic Glance", LEAD, main, ["viewer.js", "site.js"]))
    return list(titles)


def further_pages(built: Built, claims: pd.DataFrame, reports: Path) -> dict[str, tuple[str, str, str]]:
    """{name: (title, lead, main HTML)} of the pages that are about no topic; those without text are left out."""
    fidelity = "".join(opened(item) for item in built.items if item.page == "thesis")
    link = f'<p><a href="../{HOME}#thesis">{TITLE}</a>. <a href="{CLAIM_ROWS}.html">All claims, one by one</a>.</p>'
    return {
        "thesis": ("The thesis", "Which conclusions of the thesis hold, and what runs as it is printed.",
                   f"{link}<h2>Section by section</h2>{fidelity}" if fidelity else ""),
        CLAIM_ROWS: ("Claims", "Each sentence of the thesis, and of this project about its own model, has its verdict "
                     "here.", claims_main(load(), claims, reports) if len(claims) else ""),
    }  # fmt: skip


def page_html(
    titles: Mapping[str, str], name: str, title: str, lead: str, main: str, scripts: Sequence[str]
) -> str:  # fmt: skip
    """A whole page. titles: {name: title} of the pages of the menu; name: empty for the front page."""
    up, down = ("../", "") if name else ("", f"{FOLDER}/")
    addresses = {f"{up}{HOME}": "Haptic Glance"} | {f"{down}{page}.html": text for page, text in titles.items()}
    current = f"{name}.html" if name else HOME
    mark = {current: ' aria-current="page"'}
    links = (f'<a href="{address}"{mark.get(address, "")}>{text}</a>' for address, text in addresses.items())
    words = {
        "style": page_file("page.css") + page_file("site.css"),
        "title": f"{title} · Haptic Glance" if name else "Haptic Glance: results",
        "nav": " ".join(links),
        "heading": title,
        "lead": prose(lead),
        "main": main,
        "scripts": "\n".join(f"<script>\n{page_file(script)}</script>" for script in scripts),
    }
    return Template(page_file("page.html")).substitute(words)


def page_file(name: str) -> str:
    """A file of the folder page/, or of the library's viewer of meshes."""
    file = resources.files(__package__ or "") / "page" / name
    return file.read_text(encoding="utf-8") if file.is_file() else viewer.part(name)


def topic_main(name: str, results: Results, built: Built, out: Path) -> str:
    """A picture, the findings, the tables and charts that stand open, and the others folded; empty without items.

    out: the folder whose tables, charts and claims are written already; the figures of what was found are theirs.
    """
    topic, by_name = TOPICS[name], {f"{item.kind}/{item.name}": item for item in built.items if item.page == name}
    if not by_name:
        return ""
    first = next((by_name.pop(picture) for picture in topic.pictures if picture in by_name), None)
    shown = [by_name.pop(item) for item in topic.shown if item in by_name]
    texts = [] if results.own_meshes else findings(name, out)
    found = "".join(f"<li>{prose(text)}</li>" for text in texts)
    parts = {
        "": section(first) if first else "",
        "What was found": f'<ul class="found">{found}</ul>' if found else "",
        "Tables and charts": "".join(map(opened, shown)),
        "Benchmarks": page_file("benchmarks.html") if name == "speed" and not results.own_meshes else "",
        "Details": "".join(map(closed, sorted(by_name.values(), key=lambda item: isinstance(item, Table)))),
    }
    return "".join(f"{f'<h2>{head}</h2>' if head else ''}{text}\n" for head, text in parts.items() if text)


def findings(page: str, reports: Path) -> list[str]:
    """The sentences of findings.md on a page, with their figures; without those that lack a figure."""
    text = resources.files(__package__ or "").joinpath("findings.md").read_text(encoding="utf-8")
    parts = re.split(r"^# (\w+)\n", text, flags=re.MULTILINE)[1:]
    sections, sentences = dict(zip(parts[::2], parts[1::2], strict=True)), []
    for sentence in filter(None, sections.get(page, "").strip().split("\n\n")):
        with suppress(LookupError):
            sentences.append(filled(" ".join(sentence.split()), reports)[0])
    return sentences


def section(item: Table | Figure) -> str:
    """An item without its title, which a figure's caption makes clear."""
    return f'<section id="{anchor(item)}">{item.html}</section>\n'


def opened(item: Table | Figure) -> str:
    """An item that stands open."""
    return f'<section id="{anchor(item)}"><h3>{escape(item.title)}</h3>{item.html}</section>\n'


def closed(item: Table | Figure) -> str:
    """A folded item."""
    title = f"<h3>{escape(item.title)}</h3>"
    return f'<details class="item" id="{anchor(item)}"><summary>{title}</summary>{item.html}</details>\n'


def front_main(
    results: Results, built: Built, not_run: dict[str, str], meshes: dict[str, Any] | None,
    pages: Mapping[str, tuple[str, str, str]], out: Path,
) -> str:  # fmt: skip
    """The text of the front page below its head. pages: those of the menu, as `further_pages` has them."""
    by_name = {f"{item.kind}/{item.name}": item for item in built.items}
    picture = by_name.get(FIRST)
    partly = {name: "in part, as its cells say" for name, item in by_name.items()
              if isinstance(item, Table) and lacks_cells(item)}  # fmt: skip
    reasons: dict[str, list[str]] = {}
    for name, reason in (not_run | partly).items():
        reasons.setdefault(reason, []).append(f"<code>{escape(name)}</code>")
    missing = "".join(f"<li>{', '.join(names)}: {prose(reason)}</li>" for reason, names in reasons.items())
    words = {
        "heading": "Your meshes" if results.own_meshes else "The pipeline on one object",
        "what": prose(" ".join(INTRODUCTION.split())),
        "dataset": prose(dataset_line(results)),
        "pictures": image(picture, WIDE) if isinstance(picture, Figure) else "",
        "topics": "".join(
            f'<li><h3><a href="{FOLDER}/{name}.html">{title}</a></h3><p>{prose(lead)}</p></li>'
            for name, (title, lead, _) in pages.items()
        ),
        "thesis": fates_html(built, out) if not results.own_meshes else "",
        "viewer": page_file("viewer.html") if meshes else f"<p>not run: {prose(not_run.get('viewer', ''))}</p>",
        "meshes": as_script(meshes) if meshes else "null",
        "not_run": folded(f"{len(not_run | partly)} that were not, or in part", f"<ul>{missing}</ul>") if missing
        else "<p>Everything that this report knows was measured.</p>",
    }  # fmt: skip
    return Template(page_file("front.html")).substitute(words)


def fates_html(built: Built, out: Path) -> str:
    """What became of the thesis, with links to the tables behind it; empty where nothing was measured."""
    pages = {f"{item.kind}/{item.name}": f"{FOLDER}/{item.page}.html#{anchor(item)}" for item in built.items}
    frame = thesis_frame(out)
    return f"<h2>{TITLE}</h2>\n{thesis_html(frame, lambda see: pages.get(see, ''))}" if len(frame) else ""


def anchor(item: Table | Figure) -> str:
    """The id of an item's section on its page."""
    return f"{item.kind}-{item.name}"


def dataset_line(results: Results) -> str:
    """How many objects of which data set, for the head of the page."""
    try:
        return f"{len(results.objects)} objects of the data set {results.folder('meshes').parent.name}"
    except NotRun:
        return f"the data set {results.sets[0]}"
