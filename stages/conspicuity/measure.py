"""The maps of a view with their cost, and the check that they do not respond to the silhouette."""

import math
from collections.abc import Iterable

import numpy as np

from stages.kit import Mesh, Stopwatch
from stages.views import View

from .channels import conspicuity
from .silhouette import silhouette_share


def measured_maps(
    mesh: Mesh, view: View, channels: Iterable[str], size: tuple[int, int], filled: bool = True
) -> tuple[dict[str, np.ndarray], list[dict]]:
    """({channel: map}, rows): the maps of a view, and one row per map with metric `silhouette_share`.

    `seconds` is the time that each channel added, in this order: work that channels share (the filled image, the
    surface points) is charged to the first one that needs it, and work on the mesh to the first view.
    """
    maps, rows = {}, []
    for channel in channels:
        with Stopwatch() as watch:
            maps |= conspicuity(mesh, view, [channel], size, filled)
        rows.append(_row(channel, view, "silhouette_share", maps[channel], watch.seconds))
    return maps, rows


def background_rows(mesh: Mesh, view: View, channels: Iterable[str], size: tuple[int, int]) -> list[dict]:
    """Rows with metric `silhouette_share_unfilled`: the same with the background as rendered."""
    maps = conspicuity(mesh, view, channels, size, filled=False)
    return [_row(channel, view, "silhouette_share_unfilled", maps[channel], None) for channel in channels]


def _row(channel, view, metric, values, seconds):
    share = silhouette_share(values, view.mask)
    return {
        "method": channel,
        "viewpoint": view.viewpoint.name,
        "metric": metric,
        "value": None if math.isnan(share) else share,
        "seconds": seconds,
    }
