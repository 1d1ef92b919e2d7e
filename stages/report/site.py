"""The pages: a front page and, below reports/site, a page for each topic and one for the claims. All work offline."""

from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path
from string import Template
from types import ModuleType
from typing import Any

from haptic_glance.base.files import write_text

from .cells import CLAIMS
from .claims_page import claims_main, findings
from .front import findings_html, questions, questions_html
from .items import Figure, Table
from .page import box, folded, image, lacks_cells, part, prose, script_json
from .verdict import counts
from .words import dataset_text

HOME, FOLDER = "index.html", "site"
CHARTS = ("front", "touch", "attention")  # the chart of the front page: the first of these that was drawn
WIDE = 1700  # pixels of the first picture
WHAT = """A person glances at an object, knows which few places matter, touches only those, and knows what it is. Haptic
Glance does the same for 3D meshes: it predicts where people look, keeps the mesh fine there, presses a virtual pressure
array there, and recognises the object. It tests every claim of a thesis on the way, and says which fail."""


def write_site(modules: Sequence[ModuleType], parts: dict[str, Any], out: Path) -> list[str]:
    """Writes OUT/index.html and OUT/site/*.html, and removes older pages; returns the names of the pages of the site.

    modules: the topics in reading order. parts: tables, figures, tradeoff (Built), claims and differences (frames),
    known (the claims as data), results, not_run; first: the figures of the front page; own: whether these are a
    person's own meshes; meshes: those that can be turned, or None; dataset: what was measured, in words.
    """
    mains = dict(topic_mains(modules, parts, out))
    if len(parts["claims"]):
        mains[CLAIMS] = claims_main(parts["known"], parts["claims"], parts["differences"], parts["results"])
    leads = {name_of(module): (module.__doc__ or "").strip() for module in modules}
    leads[CLAIMS] = "What the thesis says, and this project of its own model, tested one by one."
    for name, main in mains.items():
        scripts = ["site.js", "claims.js"] if name == CLAIMS else ["site.js"]
        write_text(out / FOLDER / f"{name}.html", page(list(mains), name, leads[name], main, scripts))
    for path in set((out / FOLDER).glob("*.html")) - {out / FOLDER / f"{name}.html" for name in mains}:
        path.unlink()
    lead = "Look at an object, touch only the places that matter, and know what it is."
    write_text(out / HOME, page(list(mains), "", lead, front_main(parts, mains, leads, out), ["viewer.js", "site.js"]))
    return list(mains)


def page(names: Sequence[str], name: str, lead: str, main: str, scripts: Sequence[str]) -> str:
    """A whole page; names: of all pages but the front page, which has none itself."""
    up, down = ("../", "") if name else ("", f"{FOLDER}/")
    addresses = {f"{up}{HOME}": "Haptic Glance"} | {f"{down}{other}.html": other.capitalize() for other in names}
    here = f"{name}.html" if name else HOME
    mark = {here: ' aria-current="page"'}
    links = (f'<a href="{address}"{mark.get(address, "")}>{text}</a>' for address, text in addresses.items())
    words = {
        "style": part("page.css") + part("site.css"),
        "title": f"{name.capitalize()} · Haptic Glance" if name else "Haptic Glance: results",
        "nav": " ".join(links),
        "heading": name.capitalize() or "Haptic Glance",
        "lead": prose(lead),
        "main": main,
        "scripts": "\n".join(f"<script>\n{part(script)}</script>" for script in scripts),
    }
    return Template(part("page.html")).substitute(words)


def topic_mains(modules: Sequence[ModuleType], parts: dict[str, Any], out: Path) -> Iterator[tuple[str, str]]:
    """(name, text below the head) of each topic that has anything to show."""
    items = [item for kind in ("tables", "tradeoff", "figures") for item in parts[kind].items]
    for module in modules:
        main = topic_main(module, parts, [item for item in items if item.topic == name_of(module)], out)
        if main:
            yield name_of(module), main


def topic_main(module: ModuleType, parts: dict[str, Any], mine: Sequence[Table | Figure], out: Path) -> str:
    """The findings of a topic, its claims, charts and tables; those of sets that are off can be unfolded.

    out: the folder whose tables, charts and claims are written already; the figures of what was found are theirs.
    """
    claims = parts["claims"][parts["claims"]["key"].isin([claim.key for claim in module.CLAIMS])]
    others = [item for item in mine if item.sets and not set(item.sets) & set(parts["sets"])]
    if not mine and claims.empty:
        return ""
    found = [] if parts["own"] else findings(module, out)  # which are about other data sets
    text = "".join(f"<p>{prose(paragraph)}</p>" for paragraph in found)
    text = f'<section id="found" class="found"><h2>What was found</h2>{text}</section>\n' if text else ""
    shown = [item for item in mine if item not in others]
    if len(claims):
        said = ", ".join(f"<strong>{count}</strong> {word}" for word, count in counts(claims).items())
        text += f'<p>{len(claims)} <a href="{CLAIMS}.html">claims</a>: {said}.</p>\n'
    contents = "".join(f'<li><a href="#{anchor(item)}">{escape(item.title)}</a></li>' for item in [*shown, *others])
    text += f'<nav aria-label="On this page" class="contents"><ul>{contents}</ul></nav>\n' if len(mine) > 2 else ""
    text += items_html(shown)
    if others:
        sets = ", ".join(dict.fromkeys(dataset_text(name) for item in others for name in item.sets))
        text += f'<h2 id="others">Measured on other data sets</h2>\n<p>Not part of this run: {escape(sets)}.</p>\n'
        text += "".join(item.html for item in sorted(others, key=lambda item: isinstance(item, Table)))
    return text


def items_html(items: Sequence[Table | Figure]) -> str:
    """The sections of the items, charts and pictures first."""
    charts, tables = ("".join(item.html for item in items if isinstance(item, kind)) for kind in (Figure, Table))
    return (f"<h2>Charts and pictures</h2>\n{charts}" if charts else "") + (
        f"<h2>Tables</h2>\n{tables}" if tables else ""
    )


def front_main(parts: dict[str, Any], mains: dict[str, str], leads: dict[str, str], out: Path) -> str:
    """The text of the front page below its head."""
    items = [item for kind in ("tables", "tradeoff", "figures") for item in parts[kind].items]
    drawn = {item.name: item for item in items if isinstance(item, Figure)}
    topics = {f"{item.paths[0].parent.name}/{item.name}": item for item in items}
    own, not_run, meshes = parts["own"], parts["not_run"], parts["meshes"]

    def link(source: str, where: str) -> str:
        if source == CLAIMS:
            return f"{FOLDER}/{CLAIMS}.html#{where.partition('=')[2]}"
        return f"{FOLDER}/{topics[source].topic}.html#{anchor(topics[source])}"

    chart = next((drawn[name] for name in CHARTS if name in drawn), None)
    partly = {f"tables/{item.name}": "in part, as its cells say" for item in parts["tables"].items if lacks_cells(item)}
    reasons: dict[str, list[str]] = {}
    for name, why in (not_run | partly).items():
        reasons.setdefault(why, []).append(f"<code>{escape(name)}</code>")
    missing = "".join(f"<li>{', '.join(names)}: {prose(why)}</li>" for why, names in reasons.items())
    words = {
        "heading": "Your meshes" if own else "The pipeline on one object",
        "what": prose(" ".join(WHAT.split())),
        "dataset": prose(parts["dataset"]),
        "pictures": "".join(image(drawn[name], WIDE) for name in parts["first"] if name in drawn),
        "findings": "" if own else findings_html(parts["claims"], parts["differences"]),
        "questions": "" if own else questions_html(questions(out, link)),
        "chart": "" if own or chart is None else chart_html(chart),
        "viewer": part("viewer.html") if meshes else f"<p>not run: {escape(not_run.get('viewer', ''))}</p>",
        "meshes": script_json(meshes) if meshes else "null",
        "topics": "".join(
            f'<li><a href="{FOLDER}/{name}.html">{name.capitalize()}</a> {prose(leads[name])}</li>' for name in mains
        ),
        "not_run": folded(f"{len(not_run | partly)} that were not, or in part", f"<ul>{missing}</ul>") if missing
        else "<p>Everything that this report knows was measured.</p>",
    }  # fmt: skip
    return Template(part("front.html")).substitute(words)


def chart_html(chart: Figure) -> str:
    """The chart of the front page with its caption and a link to its page."""
    more = f'<a href="{FOLDER}/{chart.topic}.html#{anchor(chart)}">Its numbers</a>'
    caption = f"<figcaption>{prose(chart.caption)} {more}</figcaption>"
    body = f'<figure class="beside">{box("wide", chart.title, chart.element)}{caption}</figure>'
    return f'<section id="chart"><h2>{escape(chart.title)}</h2>{body}</section>\n'


def anchor(item: Table | Figure) -> str:
    """The id of an item's section on the page of its topic."""
    return f"{item.paths[0].parent.name}-{item.name}"


def name_of(module: ModuleType) -> str:
    """The name of a topic."""
    return module.__name__.rpartition(".")[2]
