"""A chart as SVG inside a page: text is text, colours follow the page's light and dark, marks can be hovered."""

import io
import re
from collections.abc import Sequence
from html import escape

from matplotlib.figure import Figure as Drawing

from .marks import Mark, marks
from .style import plt

PAD = 0.12  # inches round the chart
HIT = 7  # radius of the place that answers to a pointer, in typographic points
MOST = 600  # marks of a chart that one can hover; its table has them all
SCALE = 4 / 3  # pixels of the page for a typographic point
FONTS = "'DejaVu Sans', Verdana, Geneva, sans-serif"  # of one width: what was placed for the first fits the others
INK = {"#222222": "ink", "#000000": "ink", "#767676": "soft", "#d9d9d9": "line", "#ececec": "line", "#ffffff": "page"}
HEX = re.compile(r"#[0-9a-f]{6}\b")
USED = re.compile(r"(?:url\(|href=\")#([^)\"]+)")


def has_marks_alone(drawing: Drawing) -> bool:
    """Whether a drawing is a chart without any picture in it."""
    return bool(drawing.axes) and not any(axes.images for axes in drawing.axes)


def vector(drawing: Drawing, name: str, alt: str) -> tuple[str, list[Mark]]:
    """(an svg element, its marks) of a drawing; name: makes the ids in it differ from those of other charts."""
    drawing.set_dpi(72)  # then a pixel is a typographic point, the unit of matplotlib's SVG
    drawing.draw_without_rendering()
    box = drawing.get_tightbbox().padded(PAD)
    found, written = marks(drawing), io.StringIO()
    with plt.rc_context({"svg.fonttype": "none", "svg.hashsalt": name}):
        drawing.savefig(written, format="svg", bbox_inches=box, transparent=True, metadata={"Date": None})
    width, height = 72 * box.width, 72 * box.height
    spots = [(mark.spot[0] - 72 * box.x0, height - (mark.spot[1] - 72 * box.y0)) for mark in found]
    return _inline(written.getvalue(), (width, height), alt, _hits(found, spots)), found


def _hits(found: Sequence[Mark], spots: Sequence[tuple[float, float]]) -> str:
    """Circles that cannot be seen, each with what it says; none where they are too many to be told apart."""
    if len(found) > MOST:
        return ""
    circles = (
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{HIT}"><title>{escape(mark.text)}</title></circle>'
        for mark, (x, y) in zip(found, spots, strict=True)
    )
    return f'<g class="hits">{"".join(circles)}</g>'


def _inline(text: str, size: tuple[float, float], alt: str, hits: str) -> str:
    """matplotlib's file as an element of a page: without head, ids that nobody uses, and digits that nobody sees."""
    body = text.partition("<g id=")[1] + text.partition("<g id=")[2].rpartition("</svg>")[0]
    body = re.sub(r"<!--.*?-->|<metadata>.*?</metadata>", "", body, flags=re.DOTALL)
    used = set(USED.findall(body))
    body = re.sub(r' id="([^"]+)"', lambda found: found[0] if found[1] in used else "", body)
    body = re.sub(r'(?<= )(?:d|x|y|width|height|transform|points)="[^"]*"', _shorter, body)
    body = re.sub(r"'DejaVu Sans'(?:, sans-serif)?", FONTS, body)
    body = HEX.sub(_follows_page, re.sub(r"\n\s*", "\n", body)).replace("xlink:href", "href")
    width, height = size
    head = f'<svg class="chart" role="img" aria-label="{escape(alt)}" viewBox="0 0 {width:.1f} {height:.1f}"'
    return f'{head} width="{SCALE * width:.0f}" height="{SCALE * height:.0f}">{body}{hits}</svg>'


def _shorter(found: re.Match[str]) -> str:
    return re.sub(r"(\.\d\d)\d+", r"\1", found[0])


def _follows_page(found: re.Match[str]) -> str:
    """A colour as a variable of the style sheet, which a dark page sets; on a light one the colour is exact."""
    colour = found[0]
    return f"var(--{INK[colour]}, {colour})" if colour in INK else f"var(--s-{colour[1:]}, {colour})"
