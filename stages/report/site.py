"""The pages: a front page with findings and questions, and a page a topic below reports/site. All work offline.

The front page of a run on a person's own folder is that of `haptic-glance gallery`, from the pipeline's data.
"""

import re
import shlex
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from html import escape
from pathlib import Path
from string import Template
from types import ModuleType
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure as Drawing

from haptic_glance.base.files import read_table, write_text
from haptic_glance.cli.saliency import as_csv, points_of
from haptic_glance.gallery.exhibit import Exhibit, Level
from haptic_glance.gallery.page import as_script, build_page
from haptic_glance.lod import vertex_errors
from haptic_glance.lod.export import write_any
from haptic_glance.lod.pictures import coloured, look
from haptic_glance.look.points import Detection
from haptic_glance.look.points.find import scores_of
from haptic_glance.touch.places import UserMesh
from stages.imprints.imprints import read_imprints

from .cells import CLAIMS, PREFIXES, filled
from .claims_page import claims_main
from .drawing import CYCLE, INK, SETTINGS, plt
from .items import Figure, Table, findings
from .marks import vector
from .page import box, folded, image, lacks_cells, part, prose
from .results import NotRun, Results, dataset_text, there
from .tables import with_interval
from .topics import name_of
from .verdict import DEPENDS, UNTESTABLE, counts, of_thesis

ROWS = 5  # heights of the dots of a chart: pairs of like values lie beside each other


@dataclass(frozen=True)
class Finding:
    """A claim that the front page shows with its chart.

    verdict: the verdict for which the title is right; with any other verdict, the card shows the claim's own sentence.
    shown: a key of PREFIXES, the shown form of its differences. unit: of what is shown, with its direction.
    """

    key: str
    verdict: str
    title: str
    unit: str
    topic: str
    shown: str = ""
    places: int = 0

    def of(self, value: float) -> float:
        """The number that is shown of a difference."""
        return PREFIXES[self.shown](value)


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


def findings_html(claims: pd.DataFrame, differences: pd.DataFrame) -> str:
    """The cards of those FINDINGS that were measured."""
    rows = {str(row.key): row for row in claims.dropna(subset=["low"]).itertuples()}
    cards = [_card(finding, rows[finding.key], differences) for finding in FINDINGS if finding.key in rows]
    if not cards:
        return ""
    thesis = of_thesis(claims)
    tally = counts(thesis)
    unclear = UNCLEAR.format(count=len(thesis), untestable=tally[UNTESTABLE] + tally[DEPENDS], **tally)
    return f'<section id="findings"><h2>Five findings</h2><ul class="cards">{"".join(cards)}{unclear}</ul></section>\n'


def _card(finding: Finding, row, differences: pd.DataFrame) -> str:
    title = finding.title if row.verdict == finding.verdict else f"{row.claim} ({row.verdict})"
    mean, *ends = (finding.of(value) for value in (row.effect, row.low, row.high))
    low, high = sorted(ends)
    figure = with_interval(mean, low, high, places=finding.places)
    signed = "+" if mean > 0 and finding.shown == "" else ""
    pairs = differences[(differences["key"] == finding.key) & differences["judged"]]
    alt = f"{title}: {figure} {finding.unit}; a dot for each of {len(pairs)} {row.over}"
    values = dict(zip(pairs["pair"].astype(str), map(finding.of, pairs["difference"]), strict=True))
    drawing = strip(values, (mean, low, high), finding.of(0.0), finding.unit)
    chart = box("wide", f"{title}, chart", vector(drawing, finding.key, alt)[0])
    links = f'<a href="site/claims.html#{finding.key}">The claim</a>, '
    links += f'<a href="site/{finding.topic}.html">{finding.topic.capitalize()}</a>'
    return (
        f'<li><h3>{escape(title)}</h3><p class="figure"><strong>{signed}{figure}</strong> {escape(finding.unit)}</p>'
        f'{chart}<p class="help">{row.pairs} {escape(row.over)}, 95 % interval. {links}</p></li>'
    )


def strip(values: Mapping[str, float], interval: tuple[float, float, float], zero: float, unit: str) -> Drawing:
    """A chart of paired differences, a dot each, above their mean with its interval; zero: where there is no effect."""
    mean, low, high = interval
    with plt.rc_context(SETTINGS):
        drawing, axes = plt.subplots(figsize=(4.2, 1.15))
        axes.axvline(zero, color=INK, lw=1)
        for rank, (name, value) in enumerate(sorted(values.items(), key=lambda item: item[1])):
            axes.plot(value, 1 + rank % ROWS, "o", color=CYCLE[5], ms=5, mec="white", mew=0.5, label=f"_{name}")
        axes.plot([low, high], [-0.6, -0.6], color=CYCLE[0], lw=4, solid_capstyle="butt")
        axes.plot(mean, -0.6, "D", color=CYCLE[0], ms=7, mec="white", label="_mean")
        axes.set(xlabel=unit, ylim=(-1.8, ROWS + 1), xlim=_room([zero, low, high, *values.values()]))
        axes.yaxis.set_visible(False)
        axes.spines["left"].set_visible(False)
        plt.close(drawing)
    return drawing


def _room(values: Sequence[float]) -> tuple[float, float]:
    """Limits of an axis that holds all of the values."""
    low, high = np.min(values), np.max(values)
    return low - 0.06 * (high - low or 1), high + 0.06 * (high - low or 1)


def questions(reports: Path, link: Callable[[str, str], str]) -> list[tuple[str, str, str]]:
    """[(question, HTML of its answer, address)] of those whose figures were measured.

    link: from the first source of an answer, (KIND/NAME or claims, which row), to the address of its table.
    """
    answers = []
    for question, answer in re.findall(r"^# (.+)\n\n((?:.+\n?)+)", part("questions.md"), flags=re.MULTILINE):
        try:
            text, sources = filled(" ".join(answer.split()), reports)
        except LookupError:
            continue
        answers.append((question, prose(text), link(*sources[0])))
    return answers


def questions_html(answers: Sequence[tuple[str, str, str]]) -> str:
    """The section of questions, each answered in a sentence with a link to its table."""
    kinds = ("Claim" if CLAIMS in address else "Table" for _, _, address in answers)
    items = (
        ANSWER.format(asked=escape(question), answer=answer, address=address, kind=kind)
        for (question, answer, address), kind in zip(answers, kinds, strict=True)
    )
    section = f'<section id="questions"><h2>What people ask</h2><ul class="cards two">{"".join(items)}</ul></section>\n'
    return section if answers else ""


HOME, FOLDER = "index.html", "site"
CHARTS = ("front", "touch", "attention")  # the chart of the front page: the first of these that was drawn
WIDE = 1700  # pixels of the first picture
INTRODUCTION = """A person glances at an object, knows which few places matter, touches only those, and knows what it
is. Haptic Glance does the same for 3D meshes: it predicts where people look, keeps the mesh fine there, presses a
virtual pressure array there, and recognises the object. It tests every claim of a thesis on the way, and says which
fail."""


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
    leads[CLAIMS] = "Each sentence of the thesis, and of this project about its own model, has its verdict here."
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
    addresses = {f"{up}{HOME}": "Haptic Glance"} | {f"{down}{topic}.html": topic.capitalize() for topic in names}
    current = f"{name}.html" if name else HOME
    mark = {current: ' aria-current="page"'}
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


def topic_main(module: ModuleType, parts: dict[str, Any], items: Sequence[Table | Figure], out: Path) -> str:
    """The findings of a topic, its charts and tables; those of sets that are off can be unfolded.

    out: the folder whose tables, charts and claims are written already; the figures of what was found are theirs.
    """
    others = [item for item in items if item.sets and not set(item.sets) & set(parts["sets"])]
    if not items:
        return ""
    paragraphs = [] if parts["own"] else findings(module, out)  # which are about other data sets
    text = "".join(f"<p>{prose(paragraph)}</p>" for paragraph in paragraphs)
    text = f'<section id="found" class="found"><h2>What was found</h2>{text}</section>\n' if text else ""
    own_items = [item for item in items if item not in others]
    contents = "".join(f'<li><a href="#{anchor(item)}">{escape(item.title)}</a></li>' for item in [*own_items, *others])
    text += f'<nav aria-label="On this page" class="contents"><ul>{contents}</ul></nav>\n' if len(items) > 2 else ""
    text += items_html(own_items)
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
    figures = {item.name: item for item in items if isinstance(item, Figure)}
    topics = {f"{item.paths[0].parent.name}/{item.name}": item for item in items}
    own_meshes, not_run, meshes = parts["own"], parts["not_run"], parts["meshes"]

    def link(source: str, where: str) -> str:
        if source == CLAIMS:
            return f"{FOLDER}/{CLAIMS}.html#{where.partition('=')[2]}"
        return f"{FOLDER}/{topics[source].topic}.html#{anchor(topics[source])}"

    chart = next((figures[name] for name in CHARTS if name in figures), None)
    partly = {f"tables/{item.name}": "in part, as its cells say" for item in parts["tables"].items if lacks_cells(item)}
    reasons: dict[str, list[str]] = {}
    for name, reason in (not_run | partly).items():
        reasons.setdefault(reason, []).append(f"<code>{escape(name)}</code>")
    missing = "".join(f"<li>{', '.join(names)}: {prose(reason)}</li>" for reason, names in reasons.items())
    words = {
        "heading": "Your meshes" if own_meshes else "The pipeline on one object",
        "what": prose(" ".join(INTRODUCTION.split())),
        "dataset": prose(parts["dataset"]),
        "pictures": "".join(image(figures[name], WIDE) for name in parts["first"] if name in figures),
        "findings": "" if own_meshes else findings_html(parts["claims"], parts["differences"]),
        "questions": "" if own_meshes else questions_html(questions(out, link)),
        "chart": "" if own_meshes or chart is None else chart_html(chart),
        "viewer": part("viewer.html") if meshes else f"<p>not run: {prose(not_run.get('viewer', ''))}</p>",
        "meshes": as_script(meshes) if meshes else "null",
        "topics": "".join(
            f'<li><a href="{FOLDER}/{name}.html">{name.capitalize()}</a>: {prose(leads[name])}</li>' for name in mains
        ),
        "not_run": folded(f"{len(not_run | partly)} that were not, or in part", f"<ul>{missing}</ul>") if missing
        else "<p>Everything that this report knows was measured.</p>",
    }  # fmt: skip
    return Template(part("front.html")).substitute(words)


def chart_html(chart: Figure) -> str:
    """The chart of the front page with its caption and a link to its page."""
    link = f'<a href="{FOLDER}/{chart.topic}.html#{anchor(chart)}">Its numbers</a>'
    caption = f"<figcaption>{prose(chart.caption)} {link}</figcaption>"
    body = f'<figure class="beside">{box("wide", chart.title, chart.element)}{caption}</figure>'
    return f'<section id="chart"><h2>{escape(chart.title)}</h2>{body}</section>\n'


def anchor(item: Table | Figure) -> str:
    """The id of an item's section on the page of its topic."""
    return f"{item.paths[0].parent.name}-{item.name}"


MODEL, COUNT = "glance", 6  # whose places and levels are shown, else those of the first method; and how many places
UNITS = "units of the object's diameter"


def write_own_page(results: Results, pages: Sequence[str], out: Path) -> None:
    """Writes OUT/index.html and a folder of files a mesh below OUT/site; pages: the names of the site's other pages."""
    for path in filter(Path.is_dir, (out / "site").iterdir()):
        shutil.rmtree(path)
    exhibits, missing = [], dict(_refused(results))
    for name in results.objects:
        try:
            exhibits.append(exhibit_of(results, name, out / "site" / name))
        except NotRun as error:
            missing[name] = str(error)
    links = " ".join(f'<a href="site/{page}.html">{page.capitalize()}</a>' for page in pages)
    section = f'<section id="tables"><h2>Tables and charts</h2><p>{links}</p></section>' if links else ""
    folder = results.workspace.params[results.sets[0]]["meshes"].get("folder", "FOLDER")
    text = build_page("Your meshes", exhibits, missing, [f"haptic-glance gallery {shlex.quote(folder)}"], out, section)
    write_text(out / "index.html", text)


def exhibit_of(results: Results, name: str, folder: Path) -> Exhibit:
    """The findings of the pipeline on one object; its files are written into a folder. NotRun where it has no places.

    Levels and imprints that were not made are named among the missing.
    """
    mesh, by_method = results.mesh(name), results.saliency(name)
    model = MODEL if MODEL in by_method else by_method.those_of(list(by_method))[0]
    saliency, vertices = by_method[model], results.points(name)[model][:COUNT]
    points = points_of(mesh, Detection(vertices, None, saliency, scores_of(mesh, vertices, saliency)))
    folder.mkdir(parents=True)
    write_any(folder / "saliency.ply", coloured(mesh, saliency))
    write_text(folder / "points.csv", as_csv(points, mesh))
    levels, touches, images, missing = [], [], [], {}
    try:
        for target, level in results.lods(name, f"{model}-soft"):
            path = folder / f"{name}_{target.replace('%', 'pct')}.ply"
            write_any(path, level)
            levels.append(Level(level, 100 * vertex_errors(level, mesh) / mesh.diagonal, path))
    except NotRun as error:
        missing["levels"] = str(error)
    with suppress(NotRun, KeyError):
        touched = read_imprints(results.folder("imprints") / f"{name}.npz")[model]
        images_by_vertex = dict(zip(touched.vertices.tolist(), touched.images, strict=True))
        ranks = [rank for rank, vertex in enumerate(vertices.tolist(), 1) if vertex in images_by_vertex]
        touches, images = [{"index": rank} for rank in ranks], [images_by_vertex[vertices[rank - 1]] for rank in ranks]
    return Exhibit(
        name, folder, folder, UserMesh(mesh, name), _axis(results, name), saliency, points, levels, missing, touches,
        np.array(images), look(mesh, saliency, vertices), UNITS,
    )  # fmt: skip


def _axis(results, name):
    """Which axis of the object's file was taken to point up. The manifest does not tell whether the shape decided."""
    manifest = results.folder("meshes") / "manifest.csv"
    axes = read_table(there(manifest, "no manifest", "meshes")).set_index("object")["up"]
    return f"{axes[name]} is up in the file"


def _refused(results):
    """(file, why) of each file that the stage meshes refused."""
    with suppress(NotRun):
        for row in results.table("meshes", "refused.csv").itertuples():
            yield str(row.file), str(row.reason)
