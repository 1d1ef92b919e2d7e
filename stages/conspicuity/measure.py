"""The maps of a view with their cost, and the check that they do not respond to the silhouette."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from haptic_glance.base.timing import Stopwatch
from haptic_glance.look.channels.channels import PERCEIVED, conspicuity, mask_at_size
from haptic_glance.look.channels.printed import OURS
from haptic_glance.look.views import View
from haptic_glance.mesh.mesh import Mesh

from .silhouette import silhouette_share


def measured_maps(
    mesh: Mesh,
    view: View,
    channels: Iterable[str],
    size: tuple[int, int],
    filled: bool = True,
    symmetry: str = PERCEIVED,
    formulas: str = OURS,
) -> tuple[dict[str, np.ndarray], list[dict]]:
    """({channel: map}, rows): the maps of a view, and one row per map with metric `silhouette_share`.

    `seconds` is the time that each channel added, in this order: work that channels share (the filled image, the
    surface points) is charged to the first one that needs it, and work on the mesh to the first view.
    """
    maps, rows = {}, []
    for channel in channels:
        with Stopwatch() as watch:
            maps |= conspicuity(mesh, view, [channel], size, filled, symmetry, formulas)
        rows.append(_row(channel, view, "silhouette_share", maps[channel], watch.seconds))
    return maps, rows


def background_rows(
    mesh: Mesh, view: View, channels: Iterable[str], size: tuple[int, int], formulas: str = OURS
) -> list[dict]:
    """Rows with metric `silhouette_share_unfilled`: the same with the background as rendered."""
    maps = conspicuity(mesh, view, channels, size, False, formulas=formulas)
    return [_row(channel, view, "silhouette_share_unfilled", maps[channel], None) for channel in channels]


def hue_rows(
    mesh: Mesh,
    view: View,
    maps: Mapping[str, np.ndarray],
    size: tuple[int, int],
    filled: bool = True,
    formulas: str = OURS,
) -> list[dict]:
    """Rows of a view with hues, none of a grey one: what they change in its maps, {channel: map}.

    Correlations over the object's pixels, empty where a map is flat: `grey_likeness`, with the map of the same picture
    in grey of equal brightness; `intensity_likeness`, with the map of intensity.
    """
    if (view.rgb == view.rgb[..., :1]).all():
        return []
    grey = np.rint(view.rgb.mean(axis=2, keepdims=True)).astype(np.uint8).repeat(3, axis=2)
    in_grey = conspicuity(mesh, replace(view, rgb=grey), maps, size, filled, formulas=formulas)
    inside, rows = mask_at_size(view.mask, size), []
    for channel, values in maps.items():
        others = {"grey_likeness": in_grey[channel], "intensity_likeness": maps.get("intensity", values)}
        for metric, other in others.items():
            rows.append(_valued(channel, view, metric, _likeness(values[inside], other[inside])))
    return rows


def _likeness(values, others):
    flat = not len(values) or min(np.ptp(values), np.ptp(others)) == 0
    return math.nan if flat else float(np.corrcoef(values, others)[0, 1])


def _row(channel, view, metric, values, seconds):
    return _valued(channel, view, metric, silhouette_share(values, view.mask), seconds)


def _valued(channel, view, metric, value, seconds=None):
    return {
        "method": channel,
        "viewpoint": view.viewpoint.name,
        "metric": metric,
        "value": None if math.isnan(value) else value,
        "seconds": seconds,
    }
