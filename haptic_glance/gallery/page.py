"""The page of the gallery: one file that works offline, beside a folder of files per mesh."""

import base64
import io
from collections.abc import Mapping, Sequence
from html import escape
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any
from urllib.parse import quote

import numpy as np
from PIL import Image
from scipy.spatial import KDTree

from haptic_glance.base.packing import SHADES, pack, viewer_data
from haptic_glance.base.packing import Level as Drawn
from haptic_glance.lod.export import shown_mesh
from haptic_glance.lod.mesh_pictures import viridis, vivid
from haptic_glance.lod.task import number
from haptic_glance.mesh import rotate_to_z_up

from .exhibit import Exhibit
from .viewer import MOST, as_script, part

LEAST, ALL = 2_000, 160_000  # faces of a turnable mesh at least, and of all on a page: some 2 MB
WIDE = 480  # pixels of a picture


def build_page(
    title: str, exhibits: Sequence[Exhibit], failures: Mapping[str, str], commands: Sequence[str], out: Path,
    more: str = "",
) -> str:  # fmt: skip
    """The text of the page, which lies in the folder `out`.

    failures: {file: why it is left out}; commands: those that do the same; more: HTML behind the meshes.
    """
    faces = int(np.clip(ALL // max(len(exhibits), 1), LEAST, MOST))
    colours = viridis(np.linspace(0, 1, SHADES))
    package = resources.files(__package__ or "")
    words = {
        "title": escape(title),
        "style": part("page.css") + (package / "page.css").read_text("utf-8"),
        "script": part("viewer.js"),
        "failures": failures_html(failures),
        "contents": contents_html(exhibits),
        "viewer": part("viewer.html").replace('data-first="error"', 'data-first="glance"'),
        "meshes": "".join(exhibit_html(k, item, out) for k, item in enumerate(exhibits)) + more,
        "commands": escape("\n".join(commands)),
        "data": as_script(viewer_data([turnable(item, faces) for item in exhibits], colours)),
    }
    return Template((package / "page.html").read_text("utf-8")).substitute(words)


def contents_html(exhibits: Sequence[Exhibit]) -> str:
    """Links to the meshes, where there are several."""
    links = " ".join(f'<a href="#mesh-{k}">{escape(item.name)}</a>' for k, item in enumerate(exhibits))
    return f'<nav aria-label="Meshes">{links}</nav>' if len(exhibits) > 1 else ""


def turnable(item: Exhibit, faces: int) -> dict[str, Any]:
    """The data that the script turns: a mesh as it is or with so many faces, its saliency, points and levels."""
    full, nearest = shown_mesh(item.touched.mesh, faces)
    positions = item.touched.from_file(np.array([row[2:5] for row in item.points]))
    points = np.asarray(KDTree(full.vertices).query(positions)[1])
    ladder = [
        Drawn(shown_mesh(rotate_to_z_up(level.mesh), faces)[0], level.error[nearest], len(level.mesh.faces))
        for level in item.levels
    ]
    saliency, ladders = ("saliency: glance", vivid(item.saliency)[nearest]), ("saliency as weight", ladder)
    layers = {"glance": saliency}, {"glance": ("the most salient", points)}, {"glance": ladders}
    return pack(item.name, len(item.touched.mesh.faces), full, *layers)


def exhibit_html(index: int, item: Exhibit, out: Path) -> str:
    """The section of a mesh: its picture, its points with their imprints, its levels, its files. out: of the page."""
    files = quote(item.folder.relative_to(out).as_posix())
    size = " x ".join(f"{side:.4g}" for side in np.ptp(item.touched.source.vertices, axis=0))
    facts = f"{number(len(item.touched.mesh.faces), 'face')}, {size} in {item.units}; {item.note}."
    alt = f"{item.name} coloured by saliency, its {len(item.points)} most salient points numbered"
    picture = f'<img src="{data_uri(item.picture, WIDE)}" width="{WIDE}" height="{WIDE}" alt="{escape(alt)}">'
    caption = "Yellow: where people look most. Numbers: the places, most salient first; those behind are not shown."
    touches = "".join(touch_html(item, row, image) for row, image in zip(item.touches, item.images, strict=True))
    return f"""<section id="mesh-{index}"><h2>{escape(item.name)}</h2><p class="help">{escape(facts)}</p>
<div class="mesh"><figure>{picture}<figcaption>{caption}</figcaption></figure>
<div><h3>Touched there</h3><ol class="touches">{touches}</ol>
<p class="help">16 x 16 cells, 1 % of the object's diameter apart. Black is pressed first, white is far or nothing.</p>
{levels_html(item, files)}</div></div>
<details><summary>Places, and all files</summary>{places_html(item)}<p>{files_html(item, files)}</p></details></section>
"""


def touch_html(item: Exhibit, row: Mapping[str, Any], image: np.ndarray) -> str:
    """One touch: its imprint, its number, how salient its place is."""
    rank, alt = row["index"], f"what the array feels at place {row['index']} of {item.name}"
    pixels = np.rint(255 * image).astype(np.uint8)
    value = item.points[rank - 1][-1]
    return (
        f'<li><img src="{data_uri(pixels)}" width="16" height="16" alt="{escape(alt)}">'
        f"<span><b>{rank}</b> score {value:.2f}</span></li>"
    )


def levels_html(item: Exhibit, folder: str) -> str:
    """The table of levels, with their files in a folder beside the page; what is infeasible is named."""
    rows, total = [], len(item.touched.mesh.faces)
    for level in item.levels:
        faces = len(level.mesh.faces)
        link = f'<a href="{folder}/{quote(level.file.name)}" download>{escape(level.file.name)}</a>'
        rows.append(
            [link, f"{faces:,}", f"{100 * faces / total:.3g}", f"{level.error.mean():.2g}", f"{level.error.max():.2g}"]
        )
    heads = ["file", "faces", "% of all", "mean distance, %", "largest, %"]
    failures = "".join(f"<li>{escape(f'{target}: {reason}')}</li>" for target, reason in item.missing.items())
    note = '<p class="help">Distances of the mesh\'s vertices to the level, in % of its diagonal.</p>'
    body = f"{table(f'Levels of {item.name}', heads, rows)}{note}" if rows else ""
    return f"<h3>With fewer faces</h3>{body}" + (f"<ul>{failures}</ul>" if failures else "")


def places_html(item: Exhibit) -> str:
    """The table of the points in the file's coordinates."""
    rows = [[f"{rank}", f"{vertex:,}", *(f"{v:.6g}" for v in place), f"{value:.3f}"]
            for rank, vertex, *place, value in item.points]  # fmt: skip
    return table(f"Places on {item.name}", ["place", "vertex", "x", "y", "z", "score"], rows)


def table(name: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table in a box that scrolls; cells are HTML, all but the first column numbers. name: for screen readers."""
    kinds = ["", *[' class="number"'] * (len(heads) - 1)]
    head = "".join(f'<th scope="col"{kind}>{text}</th>' for kind, text in zip(kinds, heads, strict=True))
    cells = ("".join(f"<td{kind}>{text}</td>" for kind, text in zip(kinds, row, strict=True)) for row in rows)
    body = "".join(f"<tr>{row}</tr>" for row in cells)
    box = f'<div class="scroll" tabindex="0" role="region" aria-label="{escape(name)}">'
    return f"{box}<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"


def files_html(item: Exhibit, folder: str) -> str:
    """Links to the files of a mesh, in a folder beside the page."""
    names = sorted(path.name for path in item.folder.iterdir() if not path.name.startswith("."))
    return " ".join(f'<a href="{folder}/{quote(name)}">{escape(name)}</a>' for name in names)


def failures_html(failures: Mapping[str, str]) -> str:
    """The files that were left out, and why; empty where none was."""
    items = "".join(f"<li>{escape(f'{name}: {reason}')}</li>" for name, reason in failures.items())
    return f'<div class="failures" role="note">Left out:<ul>{items}</ul></div>' if items else ""


def data_uri(image: np.ndarray, wide: int | None = None) -> str:
    """A picture (h, w) or (h, w, 3) u1 as WebP, or, with its pixels unchanged, as PNG."""
    picture, stream = Image.fromarray(image), io.BytesIO()
    if wide:
        picture.thumbnail((2 * wide, 2 * wide), Image.Resampling.LANCZOS)  # fine screens have two pixels for one
        picture.save(stream, "WEBP", quality=70)
    else:
        picture.save(stream, "PNG")
    kind = "webp" if wide else "png"
    return f"data:image/{kind};base64,{base64.b64encode(stream.getvalue()).decode('ascii')}"
