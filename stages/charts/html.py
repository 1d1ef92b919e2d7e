"""HTML of the items of a page: tables to sort and filter, charts and pictures, with their words and files."""

import base64
import io
import re
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from PIL import Image

from .items import Figure, Table
from .tables import is_numeric

WIDEST = 900  # pixels of a picture on the page
LONG_TEXT = 40  # characters of a cell from which its column is wide
MOST_VIEWS = 3  # folded views of a table beside each other; more are folded together
LONG = 30  # rows after which a table scrolls in its own box
UP = "../"  # from a page of reports/site to reports/


def item_html(item: Table | Figure) -> str:
    """A table with its summary and notes, or a picture with its caption; and links to its files."""
    if isinstance(item, Table):
        notes = "".join(f"<li>{prose(note)}</li>" for note in item.notes)
        body = f'<p class="summary">{prose(item.summary)}</p>' if item.summary else ""
        first, *others = item.views
        body += f"<h4>{escape(first.title)}</h4>" if first.title else ""
        body += frame_html(first.text, item.title, first.bold)
        body += f'<p class="help">{escape(item.legend)}</p>' if item.legend else ""
        further = "".join(
            folded(escape(view.title), frame_html(view.text, f"{item.title}, {view.title}", view.bold))
            for view in others
        )
        body += folded(f"{len(others)} further tables", further) if len(others) > MOST_VIEWS else further
        body += folded("How to read it", f"<ul>{notes}</ul>") if notes else ""
        body += f"<p>{links(item.paths[:1])}</p>"
    else:
        caption = f"<figcaption>{prose(item.caption)} {links(item.paths)}</figcaption>"
        body = f"<figure>{box('wide', item.title, image(item))}{caption}</figure>"
    return body


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


def frame_html(frame: pd.DataFrame, title: str, bold: pd.DataFrame | None = None) -> str:
    """A table in its own box. bold: of each cell whether it is the best."""
    right = {column: ' class="number"' for column in frame.columns if is_numeric(frame[column])}
    right |= {c: ' class="long"' for c in frame.columns if frame[c].map(str).map(len).max() > LONG_TEXT}
    head = "".join(f'<th scope="col"{right.get(c, "")}>{escape(str(c))}</th>' for c in frame.columns)

    def cell(column: Any, text: Any, best: bool) -> str:
        shown = f"<b>{prose(str(text))}</b>" if best else prose(str(text))
        return f"<td{right.get(column, '')}>{shown}</td>"

    marks = np.zeros(frame.shape, dtype=bool) if bold is None else bold.to_numpy()
    rows = zip(frame.itertuples(index=False), marks, strict=True)
    lines = ("".join(map(cell, frame.columns, cells, best)) for cells, best in rows)
    body = "".join(f"<tr>{line}</tr>" for line in lines)
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
