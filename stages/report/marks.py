"""Marks of a drawn chart (points, bars and intervals), read back from matplotlib for the table and the SVG.

`table` lists the marks as strings. `vector` writes the chart as SVG inside a page: text stays text, the marks answer to
a pointer, and the colours follow the page's light and dark style.
"""

import io
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from itertools import chain

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.container import BarContainer
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import FixedLocator

from .drawing import plt
from .tables import number

MOST = 120  # marks of a series: of a longer one, every so many
NEAR = 1e-6  # of the span: coordinates that differ by less are one


@dataclass(frozen=True)
class Mark:
    """A value of a chart in words, and where it is in pixels of the drawing."""

    panel: str
    series: str
    x: tuple[str, str]  # what the axis shows, and the value
    y: tuple[str, str]
    interval: str
    spot: tuple[float, float]

    @property
    def text(self) -> str:
        """`kNN · noise: 0.1 · accuracy: 0.61 [0.55, 0.67]`."""
        parts = [": ".join(filter(None, side)) for side in (self.x, self.y)]
        parts[-1] += f" {self.interval}" if self.interval else ""
        return " · ".join(filter(None, [self.panel, self.series, *parts]))


def marks(drawing: Drawing) -> list[Mark]:
    """All marks of a drawing that was drawn, panel by panel; panels that show a picture have none."""
    plots = [axes for axes in drawing.axes if not axes.images and axes.get_visible()]
    return list(chain.from_iterable(_of_panel(axes, plots) for axes in plots))


def table(all_marks: Sequence[Mark]) -> pd.DataFrame:
    """The marks as a frame of strings; columns that say nothing are left out."""
    names = [{mark.x[0] for mark in all_marks}, {mark.y[0] for mark in all_marks}]
    x, y = (labels.pop() or side if len(labels) == 1 else side for side, labels in zip("xy", names, strict=True))
    x = f"{x} (across)" if x == y else x
    rows = [(mark.panel, mark.series, mark.x[1], mark.y[1], mark.interval) for mark in all_marks]
    frame = pd.DataFrame(rows, columns=["panel", "series", x, y, "95 % interval"])
    return frame[[column for column in frame if (frame[column] != "").any()]]


def _of_panel(axes: Axes, plots: Sequence[Axes]) -> Iterator[Mark]:
    panel = " ".join((axes.get_title("left") or axes.get_title() or axes.get_title("right")).split())
    names = [_axis_name(axes, plots, side) for side in "xy"]
    readers, spans = (_reader(axes.xaxis), _reader(axes.yaxis)), list(_spans(axes))
    for series, points, across in _series(axes):
        for x, y in points[:: max(1, len(points) // MOST)]:
            spot = axes.transData.transform((x, y))
            if not np.isfinite([x, y]).all() or not axes.bbox.padded(2).contains(*spot):
                continue
            interval = _interval(spans, x, y, across)
            yield Mark(panel, series, (names[0], readers[0](x)), (names[1], readers[1](y)), interval, tuple(spot))


def _axis_name(axes: Axes, plots: Sequence[Axes], side: str) -> str:
    """The label of an axis, or, of panels side by side, the only one that is written."""
    text = getattr(axes, f"get_{side}label")()
    shared = getattr(axes.figure, f"_sup{side}label", None)
    labels = {getattr(panel, f"get_{side}label")() for panel in plots} - {""} | (
        {shared.get_text()} if shared else set()
    )
    return " ".join((text or (labels.pop() if len(labels) == 1 else "")).split())


def _series(axes: Axes) -> Iterator[tuple[str, np.ndarray, bool]]:
    """(name, (k, 2) points, whether bars lie on their side) of lines with marks, of clouds of points, and of bars."""
    for line in axes.lines:
        points = np.asarray(line.get_xydata(), dtype=float)
        if line.get_transform() == axes.transData and len(points) and not _is_rule(line, points):
            yield _name(line.get_label()), points, False
    for cloud in axes.collections:
        if isinstance(cloud, PathCollection):
            yield _name(cloud.get_label()), np.ma.getdata(cloud.get_offsets()).astype(float), False
    for bars in axes.containers:
        if isinstance(bars, BarContainer):
            across = bars.orientation == "horizontal"
            yield _name(bars.get_label()), np.array([_end(bar, across) for bar in bars.patches]).reshape(-1, 2), across


def _end(bar: Rectangle, across: bool) -> tuple[float, float]:
    """The middle of the end of a bar."""
    right, up = (1, 0.5) if across else (0.5, 1)
    return bar.get_x() + right * bar.get_width(), bar.get_y() + up * bar.get_height()


def _is_rule(line: Line2D, points: np.ndarray) -> bool:
    """Whether a line is no data: the bar of an interval, a level for comparison, a step of a Pareto front."""
    bare = line.get_marker() in ("None", "", None, "|", "_")
    return bare and (len(points) < 3 or line.get_drawstyle() != "default")


def _name(label: object) -> str:
    """The name of a series; `_` before it keeps it out of the legend, and matplotlib's own `_child3` is no name."""
    text = " ".join(str(label).split())
    return "" if text.startswith(("_child", "_nolegend", "_container")) else text.removeprefix("_")


def _spans(axes: Axes) -> Iterator[tuple[int, float, float, float]]:
    """(axis along which, coordinate across, low, high) of every bar and band of an interval."""
    lines = [
        np.asarray(line.get_xydata(), dtype=float) for line in axes.lines if line.get_transform() == axes.transData
    ]
    bars = [part for group in axes.collections if isinstance(group, LineCollection) for part in group.get_segments()]
    for ends in [*lines, *bars]:
        if len(ends) == 2:
            for along in (0, 1):
                if ends[0, 1 - along] == ends[1, 1 - along] and ends[0, along] != ends[1, along]:
                    yield along, ends[0, 1 - along], ends[:, along].min(), ends[:, along].max()
    for band in axes.collections:
        if isinstance(band, PolyCollection):
            for corners in (np.asarray(path.vertices) for path in band.get_paths()):
                for x in np.unique(corners[:, 0]):
                    heights = corners[corners[:, 0] == x, 1]
                    yield 1, x, heights.min(), heights.max()


def _interval(spans: Sequence[tuple[int, float, float, float]], x: float, y: float, across: bool) -> str:
    """`[low, high]` of the narrowest bar or band through a point; a level one counts where bars lie on their side."""
    through = []
    for along, place, low, high in spans:
        value, beside = (x, y) if along == 0 else (y, x)
        if (
            abs(place - beside) <= NEAR * max(1, abs(beside))
            and low <= value <= high
            and (along == 1 or across or not through)
        ):
            through.append((high - low, low, high))
    return f"[{number(min(through)[1])}, {number(min(through)[2])}]" if through else ""


def _reader(axis: Axis) -> Callable[[float], str]:
    """The function that names a value as its axis does: by the nearest label of categories, else as a number."""
    places, labels = np.array([]), []
    if isinstance(axis.get_major_locator(), FixedLocator):
        places = np.asarray(axis.get_majorticklocs(), dtype=float)
        labels = [" ".join(text.get_text().split()) for text in axis.get_ticklabels()]
    categories = len(labels) > 0 and all(labels) and not any(map(_is_own_label, places, labels))

    def read(value: float) -> str:
        if not axis.get_visible():
            return ""
        nearest = int(np.abs(places - value).argmin()) if labels else 0
        exact = labels and labels[nearest] and abs(places[nearest] - value) <= NEAR
        return labels[nearest] if exact or categories else number(value)

    return read


def _is_own_label(place: float, label: str) -> bool:
    """Whether a label only says where it stands, as `1,500` at 1500."""
    try:
        return abs(float(label.replace(",", "").rstrip("%² ")) - place) <= NEAR * max(1, abs(place))
    except ValueError:
        return False


PAD = 0.12  # inches round the chart
HIT = 7  # radius of the place that answers to a pointer, in typographic points
MOST_PATHS = 600  # marks of a chart that one can hover; its table has them all
SCALE = 4 / 3  # pixels of the page for a typographic point
FONTS = "'DejaVu Sans', Verdana, Geneva, sans-serif"  # of one width: what was placed for the first fits the others
INK = {"#222222": "ink", "#000000": "ink", "#767676": "soft", "#d9d9d9": "line", "#ececec": "line", "#ffffff": "page"}
HEX = re.compile(r"#[0-9a-f]{6}\b")
USED = re.compile(r"(?:url\(|href=\")#([^)\"]+)")


def has_marks_alone(drawing: Drawing) -> bool:
    """Whether a drawing is a chart without any picture in it."""
    return bool(drawing.axes) and not any(axes.images for axes in drawing.axes)


def vector(drawing: Drawing, name: str, alt: str) -> tuple[str, list[Mark]]:
    """(an svg element, its marks) of a drawing; name and alt make its ids differ from those of other charts."""
    drawing.set_dpi(72)  # then a pixel is a typographic point, the unit of matplotlib's SVG
    box = drawing.get_tightbbox().padded(PAD)
    all_marks, buffer = marks(drawing), io.StringIO()
    with plt.rc_context({"svg.fonttype": "none", "svg.hashsalt": name + alt}):
        drawing.savefig(buffer, format="svg", bbox_inches=box, transparent=True, metadata={"Date": None})
    width, height = 72 * box.width, 72 * box.height
    spots = [(mark.spot[0] - 72 * box.x0, height - (mark.spot[1] - 72 * box.y0)) for mark in all_marks]
    return _inline(buffer.getvalue(), (width, height), alt, _hits(all_marks, spots)), all_marks


def _hits(all_marks: Sequence[Mark], spots: Sequence[tuple[float, float]]) -> str:
    """Circles that cannot be seen, each with what it says; none where they are too many to be told apart."""
    if len(all_marks) > MOST_PATHS:
        return ""
    circles = (
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{HIT}"><title>{escape(mark.text)}</title></circle>'
        for mark, (x, y) in zip(all_marks, spots, strict=True)
    )
    return f'<g class="hits">{"".join(circles)}</g>'


def _inline(text: str, size: tuple[float, float], alt: str, hits: str) -> str:
    """matplotlib's file as an element of a page: without head, ids that nobody uses, and digits that nobody sees."""
    body = text.partition("<g id=")[1] + text.partition("<g id=")[2].rpartition("</svg>")[0]
    body = re.sub(r"<!--.*?-->|<metadata>.*?</metadata>", "", body, flags=re.DOTALL)
    used_ids = set(USED.findall(body))
    body = re.sub(r' id="([^"]+)"', lambda match: match[0] if match[1] in used_ids else "", body)
    body = re.sub(r'(?<= )(?:d|x|y|width|height|transform|points)="[^"]*"', _shorter, body)
    body = re.sub(r"'DejaVu Sans'(?:, sans-serif)?", FONTS, body)
    body = HEX.sub(_follows_page, re.sub(r"\n\s*", "\n", body)).replace("xlink:href", "href")
    width, height = size
    head = f'<svg class="chart" role="img" aria-label="{escape(alt)}" viewBox="0 0 {width:.1f} {height:.1f}"'
    return f'{head} width="{SCALE * width:.0f}" height="{SCALE * height:.0f}">{body}{hits}</svg>'


def _shorter(match: re.Match[str]) -> str:
    return re.sub(r"(\.\d\d)\d+", r"\1", match[0])


def _follows_page(match: re.Match[str]) -> str:
    """A colour as a variable of the style sheet, which a dark page sets; on a light one the colour is exact."""
    colour = match[0]
    return f"var(--{INK[colour]}, {colour})" if colour in INK else f"var(--s-{colour[1:]}, {colour})"
