"""HTML of a page's parts: tables to sort and filter, charts to hover, pictures, and meshes to turn.

`item_html` writes a table or picture with its words and files. `pack_viewer` packs each object beside its simplified
levels, coloured by saliency or by error, for the page's viewer. Templates, scripts and styles stand in page/ and in the
viewer of the library's gallery.
"""

import base64
import io
import re
from collections.abc import Iterable
from contextlib import suppress
from html import escape
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from PIL import Image
from scipy.spatial import KDTree

from haptic_glance.base.packing import SHADES, Level, ordered, pack, viewer_data
from haptic_glance.gallery import viewer
from haptic_glance.lod import vertex_errors
from haptic_glance.lod.export import shown_mesh
from haptic_glance.mesh.mesh import Mesh

from .drawing import colour_map, label, vivid
from .items import Figure, Table
from .marks import has_marks_alone, table, vector
from .results import NotRun, Results, dataset_text, some
from .tables import is_numeric

WIDEST = 900  # pixels of a picture on the page
LONG_TEXT = 40  # characters of a cell from which its column is wide
LONG = 30  # rows after which a table scrolls in its own box
# Word -> class in the style sheet.
WORDS = {
    "supported": "yes", "contradicted": "no",
    **dict.fromkeys(("no difference", "mixed", "depends on the reading", "not testable", "open"), "open"),
}  # fmt: skip
OLDER = "Some rows are older than the code of their stage"
UP = "../"  # from a page of reports/site to reports/


def item_html(item: Table | Figure) -> str:
    """A section with links to its files: a table, its summary and notes, or a picture, its caption and numbers."""
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
        item.element, numbers = element(item)
        texts = table(numbers)
        behind = folded("The numbers behind it", frame_html(texts, f"Numbers: {item.title}")) if len(texts) else ""
        caption = f"<figcaption>{prose(item.caption)} {links(item.paths)}</figcaption>"
        body = f"<figure>{box('wide', item.title, item.element)}{caption}</figure>{behind}"
    body += folded(OLDER, f"<p>{older_text(item.record['older'])}</p>") if "older" in item.record else ""
    return f'<section id="{item.paths[0].parent.name}-{item.name}"><h3>{escape(item.title)}</h3>{body}</section>\n'


def older_text(names: Iterable[str]) -> str:
    """HTML: the files SET/STAGE of such rows, in words, and where their commit stands."""
    parts = (name.partition("/") for name in names)
    file_text = "; ".join(f"{dataset_text(dataset)} ({stage.replace('_', ' ')})" for dataset, _, stage in parts)
    return f"{escape(file_text)}. A later change may be one of form alone: provenance.json has the commit of each file."


def element(item: Figure) -> tuple[str, list]:
    """(an svg of a chart, or an img of anything that shows pictures, its marks)."""
    if has_marks_alone(item.drawing):
        return vector(item.drawing, item.name, item.alt)
    return image(item), []


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


def part(name: str) -> str:
    """A file of the package's page folder, or of the library's viewer of meshes."""
    file = resources.files(__package__ or "") / "page" / name
    return file.read_text(encoding="utf-8") if file.is_file() else viewer.part(name)


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


METHODS = [  # those that the page offers, as far as they were run: each costs an object up to 5 kB
    "glance", "itti", "thesis_ssim", "mesh_saliency", "salient_points", "heat_kernel", "random",
]  # fmt: skip
FINEST = 0.6  # of the object's faces: a finer level looks like the object itself and costs the page most
STEP = 0.75  # of the faces of the finer level before it: a closer one looks the same


def pack_viewer(results: Results) -> dict[str, Any]:
    """dict for the page's script: objects, colours. Raises NotRun without meshes or points.

    Objects are taken in the order of the settings; those that no longer fit into `viewer_kilobytes` are left out.
    """
    settings = results.settings
    objects, left_out, room = [], [], 1000 * settings.viewer_kilobytes
    for name in results.choose(settings.viewer_objects, settings.viewer_count):
        packed = pack_object(results, name)
        if len(packed["store"]) > room:
            left_out.append(name)
        else:
            room -= len(packed["store"])
            objects.append(packed)
    some(objects, f"no mesh fits into report.viewer_kilobytes={settings.viewer_kilobytes}; raise it", "report")
    colours = 255 * colour_map(np.linspace(0, 1, SHADES))
    return viewer_data(objects, colours, left_out)


def viewer_or_reason(results: Results) -> dict[str, Any] | str:
    """`pack_viewer`; the reason where there is nothing to pack, and for a folder of a person's own meshes."""
    if results.own_meshes:
        return "the page of an own folder has no viewer"
    try:
        return pack_viewer(results)
    except NotRun as missing:
        return str(missing)


def pack_object(results: Results, name: str) -> dict[str, Any]:
    """One object: the full mesh, saliency and points by method, and chains of simplified meshes by method.

    `faces` counts those of the object itself; the full mesh has at most `viewer_faces`. A level has `error`, the
    distance of each vertex of the full mesh to it.
    """
    original, points_by_method = results.mesh(name), results.points(name)
    full, nearest = shown_mesh(original, results.settings.viewer_faces)
    place = KDTree(full.vertices)
    methods = [method for method in METHODS if method in points_by_method] or list(points_by_method)
    saliency = {
        method: (f"saliency: {label(method)}", vivid(values)[nearest])
        for method, values in results.saliency(name).items()
        if method in methods
    }
    points = {
        method: (label(method), np.asarray(place.query(original.vertices[vertices])[1]))
        for method, vertices in results.strong_points(name).items()
        if method in methods
    }
    ladders = {}
    for method in results.settings.viewer_lod_methods:
        with suppress(NotRun):
            meshes = [ordered(mesh)[0] for _, mesh in results.lods(name, method)]
            levels = apart([mesh for mesh in meshes if len(mesh.faces) <= FINEST * len(full.faces)])
            ladders[method] = (
                label(method),
                [Level(mesh, 100 * vertex_errors(mesh, full) / full.diagonal, len(mesh.faces)) for mesh in levels],
            )
    return pack(name, len(original.faces), full, saliency, points, ladders)


def apart(levels: list[Mesh]) -> list[Mesh]:
    """The meshes, most faces first, that have STEP of the faces of the one kept before, or fewer."""
    spaced_meshes = []
    for mesh in levels:
        if not spaced_meshes or len(mesh.faces) <= STEP * len(spaced_meshes[-1].faces):
            spaced_meshes.append(mesh)
    return spaced_meshes
