"""The page of `haptic-glance know`: what the camera saw, what the hand felt, and the candidates after each step."""

from collections.abc import Sequence
from dataclasses import replace
from html import escape

import numpy as np

from haptic_glance.gallery.page import data_uri
from haptic_glance.gallery.viewer import part
from haptic_glance.know import Belief, Step
from haptic_glance.know.look_and_touch import CAMERA
from haptic_glance.look.camera import Viewpoint, project
from haptic_glance.look.views import render

from .know import Story, percent, seen, whence

CANDIDATES = 6  # bars of a step
SIDE = 320  # pixels of a small picture
BESIDE, HIGHEST = 40.0, 55.0  # degrees beside the hand, and above the horizon, from which its touch is shown
STYLE = """
.step { display: grid; grid-template-columns: minmax(0, 16rem) minmax(0, 16rem) minmax(0, 1fr); gap: 1.5rem; }
.step img, .step svg { display: block; width: 100%; max-width: 16rem; height: auto; aspect-ratio: 1; padding: 0;
  border: 1px solid var(--line); border-radius: 6px; background: #fff; }
.pixels { image-rendering: pixelated; }
.bars { list-style: none; margin: 0; padding: 0; }
.bars li { display: grid; grid-template-columns: 8rem 1fr 3.6rem; gap: .6rem; align-items: center; margin: .3rem 0; }
.bars b, .bars span { overflow-wrap: anywhere; font-size: .9rem; }
.bars i { display: block; height: 1rem; border-radius: 3px; background: var(--link); min-width: 1px; }
.bars div { background: var(--panel); border-radius: 3px; }
.scale { display: flex; justify-content: space-between; gap: .5rem; max-width: 16rem; font-size: .78rem;
  color: var(--soft); margin-top: .3rem; }
.ramp { max-width: 16rem; height: .6rem; margin-top: .5rem; border: 1px solid var(--line); border-radius: 3px;
  background: linear-gradient(90deg, #000, #fff); }
.end { font-size: 1.3rem; margin: .6rem 0; }
pre { white-space: pre-wrap; overflow-wrap: anywhere; background: var(--panel); border-radius: 6px; padding: .9rem;
  font-size: .86rem; }
h2:first-child { margin-top: 1.6rem; }
@media (max-width: 760px) {
  .step { grid-template-columns: minmax(0, 1fr) minmax(0, 1fr); gap: 1rem; }
  .step > :last-child { grid-column: 1 / -1; }
  .bars li { grid-template-columns: 7.4rem 1fr 3.4rem; }
  .bars b { font-size: .84rem; }
}
"""
WORDS = {"right": "yes", "wrong": "no", "undecided": "open"}  # the classes of the page's style


def build_page(story: Story, left_out: Sequence[str], command: str) -> str:
    """The text of the page, which needs no other file. left_out: files with reasons; command: that does the same."""
    title = f"{story.last.known or 'Undecided'}, {story.course}"
    known = len(story.library.names)
    truth = f"The object is {story.name}" + ("." if story.is_known else ", which is not among the known objects.")
    lead = f"{known} objects are known. A camera sees {seen(story)}, then a hand touches it."
    touches = "".join(touch_html(story, number, step) for number, step in enumerate(story.steps, 1))
    notes = "".join(f"<li>{escape(note)}</li>" for note in left_out)
    left = f"<h3>Files left out</h3><ul>{notes}</ul>" if notes else ""
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{escape(title)}</title>
<style>
{part("page.css")}{STYLE}</style>
</head>
<body>
<a class="skip" href="#main">Skip to the steps</a>
<header>
<h1>{escape(title)}</h1>
<p class="lead">{escape(lead)}</p>
<p class="end"><span class="word {WORDS[story.verdict]}">{story.verdict}</span> {escape(truth)}</p>
</header>
<main id="main">
{look_html(story)}
{touches}
<section><h2>The same again</h2>
<pre tabindex="0">{escape(command)}</pre>{left}
</section>
</main>
</body>
</html>
"""


def look_html(story: Story) -> str:
    """The section of the look."""
    alt = f"{story.name} as the camera sees it" + (", a part behind a grey board" if story.hidden else "")
    board = f" A grey board hides {100 * story.hidden:.0f} % of the object." if story.hidden else ""
    side = len(story.picture)
    return f"""<section><h2>Look</h2><div class="step">
<figure><img class="pixels" src="{data_uri(story.picture)}" width="{side}" height="{side}" \
alt="{escape(alt)}">
<figcaption>What the camera sees.{board}</figcaption></figure>
<figure><img src="{data_uri(shaded(story, CAMERA), SIDE)}" width="{SIDE}" height="{SIDE}" alt="{escape(story.name)}">
<figcaption>All of the object, from the same side. The belief does not know this picture.</figcaption></figure>
{bars_html(story.look, "the look")}</div></section>"""


def touch_html(story: Story, number: int, step: Step) -> str:
    """The section of a touch: where the hand came, what it felt, and the candidates."""
    met = np.isfinite(step.travel)
    where = f"The hand comes {whence(step.approach)}, as the camera sees it."
    where += f" It meets the object after {story.length(step.travel)}." if met else " It meets nothing."
    return f"""<section><h2>Touch {number}</h2><div class="step">
<figure>{hand_svg(story, number, step)}<figcaption>{escape(where)} The picture shows the side that is \
touched.</figcaption></figure>
<figure>{imprint_html(story, number, step) if met else "<p>No imprint: the hand met nothing.</p>"}</figure>
{bars_html(step.belief, f"touch {number}")}</div></section>"""


def imprint_html(story: Story, number: int, step: Step) -> str:
    """The imprint with its scale."""
    array = step.approach.array
    pixels = np.rint(255 * step.imprint / array.depth).astype(np.uint8)
    rows, columns = array.cells
    alt = f"Imprint of touch {number}: how far the surface lies below each cell"
    return f"""<img class="pixels" src="{data_uri(pixels)}" width="{columns}" height="{rows}" alt="{alt}">
<div class="ramp" aria-hidden="true"></div><div class="scale"><span>0</span>\
<span>{escape(story.length(array.depth))} or more</span></div>
<figcaption>How far the surface lies below each of {rows} x {columns} cells at first contact. The cells are \
{escape(story.length(array.pitch))} apart.</figcaption>"""


def hand_svg(story: Story, number: int, step: Step) -> str:
    """The object as it stands, seen from the side of the hand, with the hand's way and its array at the contact."""
    unit, approach = story.library.diameter, step.approach
    x, y, z = approach.axes[2]
    elevation = float(np.clip(np.degrees(np.arcsin(np.clip(z, -1, 1))) + 15, -HIGHEST, HIGHEST))
    camera = Viewpoint(float(np.degrees(np.arctan2(y, x))) + BESIDE, elevation)
    travel = step.travel if np.isfinite(step.travel) else 2 * unit
    place = approach.contact(travel)
    half = np.array(approach.array.cells[::-1]) * approach.array.pitch / 2
    corners = [place + (a * half[0]) * approach.axes[0] + (b * half[1]) * approach.axes[1]
               for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]  # fmt: skip
    points = np.array([approach.origin, place, *corners]) / story.shown
    rows, columns, _ = project(points, camera, (SIDE, SIDE))
    (x0, y0), (x1, y1), *outline = zip(columns.round(1).tolist(), rows.round(1).tolist(), strict=True)
    square = " ".join(f"{x},{y}" for x, y in outline)
    label = f"{story.name} from the side of the hand; the line is the way of touch {number}"
    mark = f'<polygon points="{square}" fill="#d0430044" stroke="#d04300" stroke-width="2"/>'
    mark += f'<circle cx="{x1}" cy="{y1}" r="4" fill="#d04300"/>'
    return (
        f'<svg viewBox="0 0 {SIDE} {SIDE}" role="img" aria-label="{escape(label)}">'
        f'<image href="{data_uri(shaded(story, camera), SIDE)}" width="{SIDE}" height="{SIDE}"/>'
        f'<line x1="{x0}" y1="{y0}" x2="{x1}" y2="{y1}" stroke="#d04300" stroke-width="2.5"/>'
        f"{mark if np.isfinite(step.travel) else ''}</svg>"
    )


def shaded(story: Story, camera: Viewpoint) -> np.ndarray:
    """(320, 320, 3) bytes: the object as it stands, against white."""
    small = replace(story.there, vertices=story.there.vertices / story.shown)
    view = render(small, camera, size=(SIDE, SIDE))
    return np.where((view.face >= 0)[..., None], view.rgb, 255).astype(np.uint8)


def bars_html(belief: Belief, step: str) -> str:
    """The likeliest candidates as bars, and all others together."""
    shown = [*belief.probabilities.items()]
    first, rest = shown[:CANDIDATES], shown[CANDIDATES:]
    if rest:
        first.append((f"{len(rest)} others", sum(share for _, share in rest)))
    items = "".join(
        f"<li><b>{escape(name)}</b>"
        f'<div><i style="width:{100 * share:.1f}%"></i></div><span>{escape(percent(share))}</span></li>'
        for name, share in first
    )
    return f'<div><ul class="bars" aria-label="Probabilities after {step}">{items}</ul></div>'
