"""HTML of the items of a page: tables to sort and filter, charts and pictures, with their words and files."""

import base64
import io
import re
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import Any

import pandas as pd
from PIL import Image

from .items import Figure, Table
from .tables import is_numeric

WIDEST = 900  # pixels of a picture on the page
LONG_TEXT = 40  # characters of a cell from which its column is wide
LONG = 30  # rows after which a table scrolls in its own box
UP = "../"  # from a page of reports/site to reports/


def item_html(item: Table | Figure) -> str:
    """A section with links to its files: a table, its summary and notes, or a picture and its caption."""
    if isinstance(item, Table):
        notes = "".join(f"<li>{prose(note)}</li>" for note in item.notes)
        body = f'<p class="summary">{prose(item.summary)}</p>' if item.summary else ""
        body += frame_html(item.first, item.title, bold=item.best_rows)
        if len(item.first.columns) < len(item.text.columns):
            whole = frame_html(item.text, f"All columns: {item.title}", bold=item.best_rows)
            body += folded(f"All {len(item.text.columns)} columns", whole)
        body += folded("How to read it", f"<ul>{notes}</ul>") if notes else ""
        body += f"<p>{links(item.paths[:1])}</p>"
    else:
        caption = f"<figcaption>{prose(item.caption)} {links(item.paths)}</figcaption>"
        body = f"<figure>{box('wide', item.title, image(item))}{caption}</figure>"
    return f'<section id="{item.kind}-{item.name}"><h3>{escape(item.title)}</h3>{body}</section>\n'


def image(item: Figure, widest: int = WIDEST) -> str:
    """An img of a figure's PNG."""
    source = f"data:image/webp;base64,{small_picture(item.paths[0], widest)}"
    return f'<img src="{source}" alt="{escape(item.alt)}">'


def lacks_cells(table: Table) -> bool:
    """Whether a cell of the table says "not run"."""
    return any("not run" in text for text in table.text.to_numpy().ravel())


def prose(text: str) -> str:
    """HTML of a text whose only mark-up is code between backticks."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(text))


def links(paths: list[Path]) -> str:
    """Links to files in a folder of reports/, from a page of a topic."""
    return " ".join(f'<a href="{UP}{path.parent.name}/{path.name}" download>{path.name}</a>' for path in paths)


def folded(summary: str, body: str) -> str:
    """A part that can be unfolded."""
    return f"<details><summary>{summary}</summary>{body}</details>"


def box(classes: str, title: str, body: str) -> str:
    """A part that scrolls sideways, reachable by the keyboard."""
    return f'<div class="{classes}" tabindex="0" role="region" aria-label="{escape(title)}">{body}</div>'


def frame_html(frame: pd.DataFrame, title: str, bold: Iterable[bool] = ()) -> str:
    """A table in its own box. bold: of each row whether it is the best."""
    right = {column: ' class="number"' for column in frame.columns if is_numeric(frame[column])}
    right |= {c: ' class="long"' for c in frame.columns if frame[c].map(str).map(len).max() > LONG_TEXT}
    head = "".join(f'<th scope="col"{right.get(c, "")}>{escape(str(c))}</th>' for c in frame.columns)

    def cell(column: Any, text: Any) -> str:
        return f"<td{right.get(column, '')}>{prose(str(text))}</td>"

    rows = ("".join(cell(*item) for item in row.items()) for row in frame.to_dict("records"))
    kinds = [' class="best"' if row else "" for row in bold] or [""] * len(frame)
    body = "".join(f"<tr{kind}>{row}</tr>" for kind, row in zip(kinds, rows, strict=True))
    inner = f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
    return box("scroll tall" if len(frame) > LONG else "scroll", title, inner)


def small_picture(path: Path, widest: int = WIDEST) -> str:
    """base64 of a picture as WebP, no wider than so many pixels. The PNG is linked beside it."""
    with Image.open(path) as opened:
        rgb = opened.convert("RGB")
    rgb.thumbnail((widest, max(widest, rgb.height)), Image.Resampling.LANCZOS)
    stream = io.BytesIO()
    rgb.save(stream, "WEBP", quality=60, method=4)  # 6 takes fifteen times as long for one per cent
    return base64.b64encode(stream.getvalue()).decode("ascii")
