"""The web page: one file that works offline, assembled from the templates in page/."""

import base64
import html
import io
import json
import os
from importlib import resources
from string import Template

from PIL import Image

from .markdown import is_numeric, number
from .verdict import counted

WIDEST = 900  # pixels of a picture on the page
LONG = 30  # rows after which a table scrolls in its own box
WORDS = {"supported": "yes", "contradicted": "no", "open": "open"}  # word -> class in the style sheet


def build_page(path, report, meshes, dataset):
    """The text of the page at `path`. report: dict of tables, figures, tradeoff (Built), claims (frame), not_run."""
    parts = {
        "style": part("page.css"),
        "script": part("viewer.js"),
        "meshes": script_json(meshes) if meshes else "null",
        "viewer": part("viewer.html") if meshes else no_meshes(report["not_run"].get("viewer", "")),
        "dataset": html.escape(dataset),
        "pipeline": "".join(figure_html(item, path) for item in report["figures"].items if item.name == "pipeline"),
        "claims": claims_html(report["claims"]),
        "counts": counts_html(report["claims"]),
        "counted": html.escape(counted(report["claims"])),
        "tables": "".join(table_html(item) for item in report["tables"].items),
        "figures": "".join(figure_html(item, path) for item in report["figures"].items if item.name != "pipeline"),
        "charts": "".join(figure_html(item, path) for item in report["tradeoff"].items),
        "not_run": not_run_html(report["not_run"]),
    }
    return Template(part("page.html")).substitute(parts)


def part(name):
    """A file of the package's page folder."""
    return resources.files(__package__).joinpath("page", name).read_text(encoding="utf-8")


def script_json(value):
    """JSON that is safe inside a script element."""
    return json.dumps(value, separators=(",", ":")).replace("</", "<\\/")


def table_html(item):
    """A section with a table, its notes and its CSV."""
    notes = "".join(f"<li>{html.escape(note)}</li>" for note in item.notes)
    link = f'<p><a href="tables/{item.name}.csv" download>{item.name}.csv</a></p>'
    body = frame_html(item.shown, item.title)
    return (
        f'<section id="tables-{item.name}"><h3>{html.escape(item.title)}</h3>{body}<ul>{notes}</ul>{link}</section>\n'
    )


def frame_html(frame, title, classes=None):
    """A table that scrolls sideways in its own box, reachable by the keyboard; classes: dict column -> function."""
    right = {column: ' class="number"' for column in frame.columns if is_numeric(frame[column])}
    head = "".join(f'<th scope="col"{right.get(c, "")}>{html.escape(str(c))}</th>' for c in frame.columns)

    def cell(column, text):
        kind = classes[column](text) if column in (classes or {}) else right.get(column, "")
        return f"<td{kind}>{html.escape(str(text))}</td>"

    rows = ("".join(cell(*item) for item in row.items()) for row in frame.to_dict("records"))
    body = "".join(f"<tr>{row}</tr>" for row in rows)
    tall = " tall" if len(frame) > LONG else ""
    box = f'<div class="scroll{tall}" tabindex="0" role="region" aria-label="{html.escape(title, quote=True)}">'
    return f"{box}<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"


def figure_html(item, page):
    """A picture inside the page, with links to its files."""
    picture = small_picture(item.paths[0])
    links = " ".join(f'<a href="{os.path.relpath(path, page.parent)}" download>{path.name}</a>' for path in item.paths)
    return (
        f'<section id="{item.paths[0].parent.name}-{item.name}"><h3>{html.escape(item.title)}</h3><figure>'
        f'<div class="wide" tabindex="0" role="region" aria-label="{html.escape(item.title, quote=True)}">'
        f'<img src="data:image/webp;base64,{picture}" alt="{html.escape(item.alt, quote=True)}"></div>'
        f"<figcaption>{html.escape(item.caption)} {links}</figcaption></figure></section>\n"
    )


def small_picture(path):
    """base64 of a picture as WebP, in the smaller of two ways: as drawn in few colours, or no wider than WIDEST.

    A chart is smaller as drawn: shrinking blurs its edges into many colours. Its PNG is linked beside it.
    """
    with Image.open(path) as image:
        whole = image.convert("RGB")
    shown = whole.copy()
    shown.thumbnail((WIDEST, WIDEST), Image.Resampling.LANCZOS)
    flat = whole.quantize(32, dither=Image.Dither.NONE).convert("RGB")
    packed = [_webp(shown, quality=55), _webp(flat, lossless=True, quality=60)]
    return base64.b64encode(min(packed, key=len)).decode("ascii")


def _webp(image, **how):
    packed = io.BytesIO()
    image.save(packed, "WEBP", method=4, **how)  # 6 takes fifteen times as long for one per cent
    return packed.getvalue()


def claims_html(claims):
    """The claims as a table; the word is coloured and written, never coloured alone."""
    shown = claims_shown(claims)
    word = {"verdict": lambda cell: f' class="word {WORDS[cell]}"'}
    return frame_html(shown, "Claims", word)


def claims_shown(claims):
    """The frame of claims as a person reads it: section, verdict, claim, effect, tested on, over."""
    shown = claims[["section", "verdict", "claim"]].copy()
    shown["effect"] = [effect(row) for row in claims.itertuples()]
    shown["tested on"] = claims["tested_on"]
    shown["pairs"] = [f"{row.pairs} {row.over}" if row.pairs else "–" for row in claims.itertuples()]
    return shown


def effect(row):
    """`+3.1 [1.0, 5.2] points`, or a dash; no brackets where the interval is unknown."""
    if row.effect != row.effect:
        return "–"
    sign = "+" if row.effect > 0 else ""
    span = f" [{number(row.low)}, {number(row.high)}]" if row.low == row.low else ""
    return f"{sign}{number(row.effect)}{span} {row.unit}"


def counts_html(claims):
    """One sentence of counts."""
    counts = claims["verdict"].value_counts()
    return ", ".join(f"<strong>{counts.get(word, 0)}</strong> {word}" for word in WORDS)


def not_run_html(not_run):
    """The list of what lacks its measurement."""
    if not not_run:
        return "<p>Everything that this report knows was measured.</p>"
    lines = "".join(f"<li><code>{html.escape(k)}</code>: {html.escape(v)}</li>" for k, v in not_run.items())
    return f"<ul>{lines}</ul>"


def no_meshes(reason):
    """What stands in place of the viewer."""
    return f"<p>not run: {html.escape(reason)}</p>"
