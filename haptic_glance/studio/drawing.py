"""Draws a touch: the array on the object in the scene, and imprints and beliefs as HTML in a panel.

Cells have no smoothing, and bars have their numbers beside them.
"""

from collections.abc import Mapping
from html import escape

import numpy as np

from haptic_glance.gallery.page import data_uri
from haptic_glance.lod.mesh_pictures import viridis

from .feeling import Felt
from .scene import RED, Scene

THICK = 0.006  # units, of lines
DOT = 0.85  # of the pitch: a cell as it is drawn on the object


def draw_array(scene: Scene, name: str, felt: Felt) -> None:
    """The outline of the array in its pose, and its cells where they met the object, in the colours of the grid."""
    lines = np.stack([felt.corners, np.roll(felt.corners, -1, axis=0)], axis=1).astype(np.float32)
    scene.api.add_line_segments(f"{name}/outline", lines, RED, thickness=THICK)
    draw_cells(scene, f"{name}/cells", felt)


def draw_cells(scene: Scene, name: str, felt: Felt) -> None:
    """The cells alone, where they met the object."""
    places, values = felt.contacts
    if not len(places):
        scene.clear(name)
        return
    scene.api.add_point_cloud(
        name, places, viridis(values), point_size=DOT * felt.pitch, point_shape="square", precision="float32",
        point_shading="flat",
    )  # fmt: skip


BARS = 8  # of the likeliest objects; the others are counted
SURE, MAYBE = "#0b7a43", "#00558c"


def grid_html(pressed: np.ndarray, span: tuple[float, float], unit: str, words: str) -> str:
    """pressed (rows, cols) in 0..1 as square cells with a legend; span: what 0 and 1 stand for, in `unit`."""
    rows, columns = pressed.shape
    ramp = ", ".join(f"rgb({r},{g},{b})" for r, g, b in viridis(np.linspace(0, 1, 9)))
    low, high = (f"{value:.3g}" for value in span)
    words = f"{words}, in {unit}" if unit else words
    return (
        '<div style="padding:0 0.6em 0.6em">'
        f'<img class="grid" alt="{escape(words)}" src="{_source(pressed)}" width="{columns}" height="{rows}" '
        'style="image-rendering:pixelated;width:100%;max-width:15em;height:auto;display:block;margin:auto">'
        f'<div style="height:0.6em;max-width:15em;margin:0.4em auto 0;background:linear-gradient(90deg,{ramp})"></div>'
        '<div style="display:flex;justify-content:space-between;max-width:15em;margin:auto;font-size:0.8em">'
        f'<span class="low">{low}</span><span>pressed harder →</span><span class="high">{high}</span></div>'
        f'<div class="words" style="font-size:0.8em;text-align:center">{escape(words)}</div></div>'
    )


def picture_html(picture: np.ndarray, words: str) -> str:
    """A picture (h, w, 3) u1, at most 10 em wide, with words below it."""
    return (
        '<div style="padding:0 0.6em 0.6em">'
        f'<img class="picture" alt="{escape(words)}" src="{data_uri(picture)}" '
        'style="width:100%;max-width:10em;display:block;margin:auto">'
        f'<div style="font-size:0.8em;text-align:center">{escape(words)}</div></div>'
    )


def bars_html(probabilities: Mapping[str, float], sure: str) -> str:
    """A bar for each of the likeliest objects, those first; sure: the one that is known, or empty."""
    likeliest = list(probabilities.items())[:BARS]
    remaining = len(probabilities) - len(likeliest)
    lines = [_bar(name, value, SURE if name == sure else MAYBE) for name, value in likeliest]
    if remaining > 0:
        share = max(1 - sum(value for _, value in likeliest), 0.0)
        lines.append(f'<div style="font-size:0.8em">and {remaining} more, {share:.0%} together</div>')
    return '<div class="bars" style="padding:0 0.6em 0.6em">' + "".join(lines) + "</div>"


def _bar(name, value, colour):
    return (
        f'<div class="bar" data-name="{escape(name)}" style="display:flex;align-items:center;gap:0.4em;'
        f'font-size:0.8em;line-height:1.5"><span style="width:8.5em;overflow:hidden;text-overflow:ellipsis;'
        f'white-space:nowrap">{escape(name)}</span><span style="flex:1;background:rgba(128,128,128,0.2)">'
        f'<span style="display:block;height:0.8em;width:{100 * value:.1f}%;background:{colour}"></span></span>'
        f'<span style="width:2.8em;text-align:right">{value:.0%}</span></div>'
    )


def _source(pressed):
    """One pixel a cell."""
    return data_uri(viridis(pressed.ravel()).reshape(*pressed.shape, 3))
