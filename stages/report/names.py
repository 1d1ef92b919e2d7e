"""Names beside the points of a chart, where they cover neither each other nor a point."""

from collections.abc import Iterable, Sequence
from itertools import product
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox

from .style import GREY, INK

SIDES = [(1, 1), (-1, 1), (1, -1), (-1, -1), (1, 0), (-1, 0), (0, 1), (0, -1)]  # of the point, the best first
GAPS = [8, 14, 26, 40]  # from the point to its name, in typographic points
FAR = 14  # a name from this gap on gets a thin line to its point
CROSSING = 15  # a crossed line is as bad as so much more of a gap
SIZE, RADIUS = 8.5, 5.5  # of the letters and of a point with its rim, in typographic points


Spot = tuple[float, float]


def place_names(
    axes: Axes, names: Iterable[tuple[str, Spot]], points: np.ndarray, lines: Iterable[Sequence[Spot]]
) -> list[Annotation]:
    """Writes each name at the nearest free place around its point; returns the texts.

    names: list of (text, (x, y)); points (k, 2): all that no name may cover; lines: list of two ends each, which names
    avoid where they can. All in the data's units. To be called last, when nothing moves the limits of the
    axes any more. A name that finds no free place is left out.
    """
    figure: Any = axes.figure  # whole, no part of one
    figure.draw_without_rendering()  # limits are settled only by drawing
    scale = figure.dpi / 72
    to_pixels = axes.transData.transform
    taken = [_around(spot[None], RADIUS * scale) for spot in to_pixels(points)]
    strokes = [_around(to_pixels(ends), scale) for ends in lines]
    written = []
    for text, point in names:
        probe, spot = axes.text(0, 0, text, fontsize=SIZE), to_pixels(point)
        extent = probe.get_window_extent()
        probe.remove()
        found = _nearest(axes, (extent.width, extent.height), spot, taken, strokes, scale)
        if found is None:
            continue
        gap, box = found
        taken.append(box)
        place = {"xytext": ((box.x0 - spot[0]) / scale, (box.y0 - spot[1]) / scale), "textcoords": "offset points"}
        if gap >= FAR:
            taken += _leader(spot, box, scale)
            place["arrowprops"] = {"arrowstyle": "-", "color": GREY, "lw": 0.6, "shrinkA": 0, "shrinkB": 4}
        written.append(axes.annotate(text, point, ha="left", va="bottom", fontsize=SIZE, color=INK, zorder=4, **place))
    return written


def _nearest(
    axes: Axes, extent: Spot, spot: np.ndarray, taken: list[Bbox], strokes: list[Bbox], scale: float
) -> tuple[float, Bbox] | None:
    """(gap, box) of the best free place, or None. taken: what no name may cover; strokes: what it better does not."""
    window, free = axes.get_window_extent(), []
    for gap, side in product(GAPS, SIDES):
        box = _beside(spot, extent, side, gap * scale)
        inside = window.x0 <= box.x0 and box.x1 <= window.x1 and window.y0 <= box.y0 and box.y1 <= window.y1
        led = _leader(spot, box, scale) if gap >= FAR else []  # its line would belong to others where it crosses them
        free_way = not any(part.count_overlaps(taken + strokes) for part in led)
        if inside and free_way and not box.count_overlaps(taken):
            free.append((gap + CROSSING * box.count_overlaps(strokes), len(free), gap, box))
    return min(free)[2:] if free else None


def _leader(spot: np.ndarray, box: Bbox, scale: float) -> list[Bbox]:
    """Small boxes along the thin line to a name, from a little way off its point."""
    middle = np.array([(box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2])
    near = min(1.0, 2 * RADIUS * scale / np.linalg.norm(middle - spot))
    return [_around((spot + share * (middle - spot))[None], scale) for share in np.linspace(near, 1, 30)]


def _beside(spot: np.ndarray, extent: Spot, side: tuple[int, int], gap: float) -> Bbox:
    """The box of a text of this extent at one side of a spot, in pixels."""
    (x, y), (width, height), (across, up) = spot, extent, side
    step = gap if across == 0 or up == 0 else 0.7 * gap  # at a corner both ways count
    x0 = x - width / 2 + across * (width / 2 + step)
    y0 = y - height / 2 + up * (height / 2 + step)
    return Bbox.from_extents(x0, y0, x0 + width, y0 + height)


def _around(spots: np.ndarray, margin: float) -> Bbox:
    """The box around spots (k, 2) with a margin: around one point, or the ends of an upright or level line."""
    return Bbox([spots.min(axis=0) - margin, spots.max(axis=0) + margin])
