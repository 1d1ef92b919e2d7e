"""The web page: one file that works offline, assembled from the templates in page/."""

import base64
import io
import json
import re
from collections.abc import Sequence
from html import escape
from importlib import resources
from pathlib import Path
from string import Template
from types import ModuleType
from typing import Any

import pandas as pd
from PIL import Image

from .items import Figure, Table
from .markdown import is_numeric, with_interval
from .prose import findings
from .verdict import counted, counts

WIDEST = 900  # pixels of a picture on the page
LOSSLESS = 2  # times the bytes of the lossy picture: all charts of the report take less, most renderings more
LONG = 30  # rows after which a table scrolls in its own box
# Word -> class in the style sheet.
WORDS = {"supported": "yes", "contradicted": "no", "no difference": "open", "open": "open"}


def build_page(modules: Sequence[ModuleType], parts: dict[str, Any]) -> str:
    """The text of the page. modules: the topics in reading order.

    parts: tables, figures, tradeoff (Built), claims (frame), not_run, sets (that are switched on), and first, the names
    of the figures that stand before all topics; own: whether these show a person's own meshes; meshes: those that can
    be turned, or None; dataset: what was measured, in words.
    """
    items = [item for kind in ("tables", "tradeoff", "figures") for item in parts[kind].items]
    first = [item for item in items if item.name in parts["first"]]
    rest = [item for item in items if item not in first]
    judged, not_run, meshes = parts["claims"], parts["not_run"], parts["meshes"]
    claims = Template(part("claims.html")).substitute(counted=escape(counted(judged))) if len(judged) else ""
    topics = {module.__name__.rpartition(".")[2]: topic_html(module, parts, rest) for module in modules}
    sections = [name for name, text in {"claims": claims, **topics}.items() if text]
    partly = {f"tables/{item.name}": "in part, as its cells say" for item in parts["tables"].items if lacks_cells(item)}
    missing = "".join(f"<li><code>{escape(name)}</code>: {prose(why)}</li>" for name, why in (not_run | partly).items())
    words = {
        "style": part("page.css"),
        "script": part("viewer.js"),
        "meshes": script_json(meshes) if meshes else "null",
        "viewer": part("viewer.html") if meshes else f"<p>not run: {escape(not_run.get('viewer', ''))}</p>",
        "dataset": prose(parts["dataset"]),
        "heading": "Your meshes" if parts["own"] else "The pipeline on one object",
        "first": "".join(item.html for item in first),
        "contents": " ".join(f'<a href="#{name}">{name.capitalize()}</a>' for name in sections),
        "claims": claims,
        "topics": "".join(topics.values()),
        "not_run": f"<ul>{missing}</ul>" if missing else "<p>Everything that this report knows was measured.</p>",
    }
    return Template(part("page.html")).substitute(words)


def topic_html(module: ModuleType, parts: dict[str, Any], items: list[Table | Figure]) -> str:
    """A section: what the project found, the claims, and the items; those of sets that are off can be unfolded."""
    name, lead = module.__name__.rpartition(".")[2], prose((module.__doc__ or "").strip())
    claims = parts["claims"][parts["claims"]["key"].isin([claim.key for claim in module.CLAIMS])]
    mine = [item for item in items if item.topic == name]
    others = [item for item in mine if item.sets and not set(item.sets) & set(parts["sets"])]
    if not mine and claims.empty:
        return ""
    found = "" if parts["own"] else findings(module)  # which are about other data sets
    text = "".join(f"<p>{prose(paragraph)}</p>" for paragraph in found.strip().split("\n\n") if paragraph)
    if len(claims):
        said = ", ".join(f"<strong>{count}</strong> {word}" for word, count in counts(claims).items())
        text += _folded(f"{len(claims)} claims: {said}", frame_html(claims_shown(claims), "Claims", "verdict"))
    text += "".join(item.html for item in mine if item not in others)
    if others:
        sets = ", ".join(dict.fromkeys(name for item in others for name in item.sets))
        said = f"{len(others)} more, measured on data sets that are not part of this run: {sets}"
        text += _folded(escape(said), "".join(item.html for item in others))
    return f'<section id="{name}"><h2>{name.capitalize()}</h2><p class="lead">{lead}</p>{text}</section>\n'


def item_html(item: Table | Figure) -> str:
    """A section: a table with its notes, or a picture with its caption, and links to its files."""
    if isinstance(item, Table):
        notes = "".join(f"<li>{prose(note)}</li>" for note in item.notes)
        body = f"{frame_html(item.text, item.title)}<ul>{notes}</ul><p>{_link(item.paths[0])}</p>"
    else:
        picture = small_picture(item.paths[0])
        image = f'<img src="data:image/webp;base64,{picture}" alt="{escape(item.alt)}">'
        caption = f"{prose(item.caption)} {' '.join(map(_link, item.paths))}"
        body = f"<figure>{_box('wide', item.title, image)}<figcaption>{caption}</figcaption></figure>"
    return f'<section id="{item.paths[0].parent.name}-{item.name}"><h3>{escape(item.title)}</h3>{body}</section>\n'


def lacks_cells(table: Table) -> bool:
    """Whether a cell of the table says that something was not run."""
    return any("not run" in text for text in table.text.to_numpy().ravel())


def prose(text: str) -> str:
    """HTML of a text whose only mark-up is code between backticks."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))


def part(name: str) -> str:
    """A file of the package's page folder."""
    return resources.files(__package__ or "").joinpath("page", name).read_text(encoding="utf-8")


def script_json(value: object) -> str:
    """JSON that is safe inside a script element."""
    return json.dumps(value, separators=(",", ":")).replace("</", "<\\/")


def _link(path: Path) -> str:
    return f'<a href="{path.parent.name}/{path.name}" download>{path.name}</a>'


def _folded(summary: str, body: str) -> str:
    return f"<details><summary>{summary}</summary>{body}</details>"


def _box(classes: str, title: str, body: str) -> str:
    """What scrolls sideways, reachable by the keyboard."""
    return f'<div class="{classes}" tabindex="0" role="region" aria-label="{escape(title)}">{body}</div>'


def frame_html(frame: pd.DataFrame, title: str, words: str = "") -> str:
    """A table in its own box; words: the column of WORDS, which are coloured and written, never coloured alone."""
    right = {column: ' class="number"' for column in frame.columns if is_numeric(frame[column])}
    head = "".join(f'<th scope="col"{right.get(c, "")}>{escape(str(c))}</th>' for c in frame.columns)

    def cell(column: Any, text: Any) -> str:
        kind = f' class="word {WORDS[text]}"' if column == words else right.get(column, "")
        return f"<td{kind}>{escape(str(text))}</td>"

    rows = ("".join(cell(*item) for item in row.items()) for row in frame.to_dict("records"))
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    table = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
    return _box("scroll tall" if len(frame) > LONG else "scroll", title, table)


def small_picture(path: Path) -> str:
    """base64 of a picture as WebP: lossless, or lossy and no wider than WIDEST where that saves more than half.

    So charts keep the colours of their series, and renderings of meshes stay small. The PNG is linked beside it.
    """
    with Image.open(path) as image:
        whole = image.convert("RGB")
    shown = whole.copy()
    shown.thumbnail((WIDEST, max(WIDEST, whole.height)), Image.Resampling.LANCZOS)
    lossy, lossless = _webp(shown, quality=55), _webp(whole, lossless=True, quality=60)
    return base64.b64encode(lossless if len(lossless) <= LOSSLESS * len(lossy) else lossy).decode("ascii")


def _webp(image: Image.Image, **how: Any) -> bytes:
    packed = io.BytesIO()
    image.save(packed, "WEBP", method=4, **how)  # 6 takes fifteen times as long for one per cent
    return packed.getvalue()


def claims_shown(claims: pd.DataFrame) -> pd.DataFrame:
    """The frame of claims as a person reads it: section, verdict, claim, effect, tested on, over."""
    shown = claims[["section", "verdict", "claim"]].copy()
    shown["effect"] = [effect(row) for row in claims.itertuples()]
    shown["holds"] = claims["holds"]
    shown["tested on"] = claims["tested_on"]
    shown["pairs"] = [f"{row.pairs} {row.over}" if row.pairs else "–" for row in claims.itertuples()]
    return shown


def effect(row: Any) -> str:
    """`+3.1 [1.0, 5.2] points`, or a dash; no brackets where the interval is unknown."""
    if row.effect != row.effect:
        return "–"
    return f"{'+' if row.effect > 0 else ''}{with_interval(row.effect, row.low, row.high)} {row.unit}"
