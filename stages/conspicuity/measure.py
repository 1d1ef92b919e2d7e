"""The maps of a view with what they cost, and the check that they keep off the silhouette."""

import math

from stages.kit import Stopwatch

from .channels import conspicuity
from .silhouette import silhouette_share


def measured_maps(mesh, view, channels, size):
    """({channel: map}, rows): the maps of a view, and a row for each with metric `silhouette_share`.

    `seconds` is what the channel added in this order: work that channels share (the filled image, the surface points)
    is charged to the first that asks for it, work on the mesh to the first view.
    """
    maps, rows = {}, []
    for channel in channels:
        with Stopwatch() as watch:
            maps |= conspicuity(mesh, view, [channel], size)
        rows.append(_row(channel, view, "silhouette_share", maps[channel], watch.seconds))
    return maps, rows


def background_rows(mesh, view, channels, size):
    """Rows with metric `silhouette_share_unfilled`: the same with the background left in the image as rendered."""
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
