"""The web page: one file that works offline, assembled from the templates in page/."""

import base64
import html
import io
import json
import os
from collections.abc import Callable, Mapping, Sequence
from importlib import resources
from pathlib import Path
from string import Template
from types import ModuleType
from typing import Any

import pandas as pd
from PIL import Image

from .items import Figure, Table
from .markdown import is_numeric, number
from .prose import findings
from .verdict import counted

WIDEST = 900  # pixels of a picture on the page
LONG = 30  # rows after which a table scrolls in its own box
WORDS = {"supported": "yes", "contradicted": "no", "open": "open"}  # word -> class in the style sheet


def build_page(
    path: Path, modules: Sequence[ModuleType], parts: dict[str, Any], meshes: dict | None, dataset: str
) -> str:
    """The text of the page at `path`. modules: the topics in reading order.

    parts: tables, figures, tradeoff (Built), claims (frame), not_run, sets (that are switched on), and first, the names
    of the figures that stand before all topics; own: whether these show a person's own meshes.
    """
    items = [item for kind in ("tables", "tradeoff", "figures") for item in parts[kind].items]
    first = [item for item in items if item.name in parts["first"]]
    topics = [Topic(module, parts, [item for item in items if item not in first]) for module in modules]
    topics = [topic for topic in topics if topic.own or topic.others or len(topic.claims)]
    claims = Template(part("claims.html")).substitute(counted=html.escape(counted(parts["claims"])))
    claims = claims if len(parts["claims"]) else ""
    sections = [*(["claims"] if claims else []), *(topic.name for topic in topics)]
    without = html.escape(parts["not_run"].get("viewer", ""))
    words = {
        "style": part("page.css"),
        "script": part("viewer.js"),
        "meshes": script_json(meshes) if meshes else "null",
        "viewer": part("viewer.html") if meshes else f"<p>not run: {without}</p>",
        "dataset": html.escape(dataset),
        "heading": "Your meshes" if parts["own"] else "The pipeline on one object",
        "first": "".join(figure_html(item, path) for item in first),
        "contents": " ".join(f'<a href="#{name}">{name.capitalize()}</a>' for name in sections),
        "claims": claims,
        "topics": "".join(topic_html(topic, path) for topic in topics),
        "not_run": not_run_html(parts["not_run"]),
    }
    return Template(part("page.html")).substitute(words)


class Topic:
    """What the page shows of a topic: its claims, and its items, those of the sets that are switched on first."""

    def __init__(self, module: ModuleType, parts: dict[str, Any], items: list[Table | Figure]) -> None:
        self.module, self.name = module, module.__name__.rpartition(".")[2]
        self.claims = parts["claims"][parts["claims"]["key"].isin([claim.key for claim in module.CLAIMS])]
        mine = [item for item in items if item.topic == self.name]
        self.own = [item for item in mine if not item.sets or set(item.sets) & set(parts["sets"])]
        self.others = [item for item in mine if item not in self.own]
        self.findings = "" if parts["own"] else findings(module)  # which are about other data sets


def topic_html(topic: Topic, page: Path) -> str:
    """A section: what the project found, the claims, and the items; those of other sets can be unfolded."""
    lead = (topic.module.__doc__ or "").strip()
    found = "".join(f"<p>{html.escape(text)}</p>" for text in topic.findings.strip().split("\n\n") if text)
    claims, others = "", ""
    if len(topic.claims):
        said = f"{len(topic.claims)} claims: {counts_html(topic.claims)}"
        claims = f"<details><summary>{said}</summary>{claims_html(topic.claims)}</details>"
    if topic.others:
        sets = ", ".join(dict.fromkeys(name for item in topic.others for name in item.sets))
        said = f"{len(topic.others)} more, measured on data sets that are not part of this run: {sets}"
        body = "".join(item_html(item, page) for item in topic.others)
        others = f"<details><summary>{html.escape(said)}</summary>{body}</details>"
    own = "".join(item_html(item, page) for item in topic.own)
    return (
        f'<section id="{topic.name}"><h2>{topic.name.capitalize()}</h2><p class="lead">{html.escape(lead)}</p>'
        f"{found}{claims}{own}{others}</section>\n"
    )


def item_html(item: Table | Figure, page: Path) -> str:
    """A table, a figure or a chart."""
    return table_html(item) if isinstance(item, Table) else figure_html(item, page)


def part(name: str) -> str:
    """A file of the package's page folder."""
    return resources.files(__package__ or "").joinpath("page", name).read_text(encoding="utf-8")


def script_json(value: object) -> str:
    """JSON that is safe inside a script element."""
    return json.dumps(value, separators=(",", ":")).replace("</", "<\\/")


def table_html(item: Table) -> str:
    """A section with a table, its notes and its CSV."""
    notes = "".join(f"<li>{html.escape(note)}</li>" for note in item.notes)
    link = f'<p><a href="tables/{item.name}.csv" download>{item.name}.csv</a></p>'
    body = frame_html(item.text, item.title)
    return (
        f'<section id="tables-{item.name}"><h3>{html.escape(item.title)}</h3>{body}<ul>{notes}</ul>{link}</section>\n'
    )


def frame_html(frame: pd.DataFrame, title: str, classes: Mapping[str, Callable[[str], str]] = {}) -> str:
    """A table that scrolls sideways in its own box, reachable by the keyboard; classes: dict column -> function."""
    right = {column: ' class="number"' for column in frame.columns if is_numeric(frame[column])}
    head = "".join(f'<th scope="col"{right.get(c, "")}>{html.escape(str(c))}</th>' for c in frame.columns)

    def cell(column: Any, text: Any) -> str:
        kind = classes[column](text) if column in classes else right.get(column, "")
        return f"<td{kind}>{html.escape(str(text))}</td>"

    rows = ("".join(cell(*item) for item in row.items()) for row in frame.to_dict("records"))
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    tall = " tall" if len(frame) > LONG else ""
    box = f'<div class="scroll{tall}" tabindex="0" role="region" aria-label="{html.escape(title, quote=True)}">'
    return f"{box}<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"


def figure_html(item: Figure, page: Path) -> str:
    """A picture inside the page, with links to its files."""
    picture = small_picture(item.paths[0])
    links = " ".join(f'<a href="{os.path.relpath(path, page.parent)}" download>{path.name}</a>' for path in item.paths)
    return (
        f'<section id="{item.paths[0].parent.name}-{item.name}"><h3>{html.escape(item.title)}</h3><figure>'
        f'<div class="wide" tabindex="0" role="region" aria-label="{html.escape(item.title, quote=True)}">'
        f'<img src="data:image/webp;base64,{picture}" alt="{html.escape(item.alt, quote=True)}"></div>'
        f"<figcaption>{html.escape(item.caption)} {links}</figcaption></figure></section>\n"
    )


def small_picture(path: Path) -> str:
    """base64 of a picture as WebP, in the smaller of two ways: as drawn in few colours, or no wider than WIDEST.

    A chart is smaller as drawn: shrinking blurs its edges into many colours. Its PNG is linked beside it.
    """
    with Image.open(path) as image:
        whole = image.convert("RGB")
    shown = whole.copy()
    shown.thumbnail((WIDEST, max(WIDEST, whole.height)), Image.Resampling.LANCZOS)
    flat = whole.quantize(32, dither=Image.Dither.NONE).convert("RGB")
    packed = [_webp(shown, quality=55), _webp(flat, lossless=True, quality=60)]
    return base64.b64encode(min(packed, key=len)).decode("ascii")


def _webp(image: Image.Image, **how: Any) -> bytes:
    packed = io.BytesIO()
    image.save(packed, "WEBP", method=4, **how)  # 6 takes fifteen times as long for one per cent
    return packed.getvalue()


def claims_html(claims: pd.DataFrame) -> str:
    """The claims as a table; the word is coloured and written, never coloured alone."""
    return frame_html(claims_shown(claims), "Claims", {"verdict": lambda cell: f' class="word {WORDS[cell]}"'})


def claims_shown(claims: pd.DataFrame) -> pd.DataFrame:
    """The frame of claims as a person reads it: section, verdict, claim, effect, tested on, over."""
    shown = claims[["section", "verdict", "claim"]].copy()
    shown["effect"] = [effect(row) for row in claims.itertuples()]
    shown["tested on"] = claims["tested_on"]
    shown["pairs"] = [f"{row.pairs} {row.over}" if row.pairs else "–" for row in claims.itertuples()]
    return shown


def effect(row: Any) -> str:
    """`+3.1 [1.0, 5.2] points`, or a dash; no brackets where the interval is unknown."""
    if row.effect != row.effect:
        return "–"
    sign = "+" if row.effect > 0 else ""
    span = f" [{number(row.low)}, {number(row.high)}]" if row.low == row.low else ""
    return f"{sign}{number(row.effect)}{span} {row.unit}"


def counts_html(claims: pd.DataFrame) -> str:
    """One sentence of counts."""
    counts = claims["verdict"].value_counts()
    return ", ".join(f"<strong>{counts.get(word, 0)}</strong> {word}" for word in WORDS)


def not_run_html(not_run: Mapping[str, str]) -> str:
    """The list of what lacks its measurement."""
    if not not_run:
        return "<p>Everything that this report knows was measured.</p>"
    lines = "".join(f"<li><code>{html.escape(k)}</code>: {html.escape(v)}</li>" for k, v in not_run.items())
    return f"<ul>{lines}</ul>"
