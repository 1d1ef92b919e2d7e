"""The conspicuity maps of an object with their cost, their files, and the share of a map along the silhouette.

The share shows that maps do not respond to the silhouette, and hence not to the background.
"""

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays
from haptic_glance.base.lazy import cv2
from haptic_glance.base.timing import Stopwatch
from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels.channels import PERCEIVED, conspicuity, mask_at_size
from haptic_glance.look.channels.printed import OURS
from haptic_glance.look.channels.view_maps import ViewMaps
from haptic_glance.look.views import View
from haptic_glance.mesh.mesh import Mesh


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
        references = {"grey_likeness": in_grey[channel], "intensity_likeness": maps.get("intensity", values)}
        for metric, reference in references.items():
            rows.append(_valued(channel, view, metric, _likeness(values[inside], reference[inside])))
    return rows


def _likeness(values, reference):
    flat = not len(values) or min(np.ptp(values), np.ptp(reference)) == 0
    return math.nan if flat else float(np.corrcoef(values, reference)[0, 1])


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


BAND = 12 / 900  # of the image's rows: 12 pixels in the thesis's 1200 x 900


def silhouette_share(values: np.ndarray, mask: np.ndarray) -> float:
    """The share of a map's sum in a band along the silhouette, over the band's share of the object's area.

    1: in proportion to the area; well above 1: the map responds to the silhouette. values (h', w') f4, a map of
    conspicuity(); mask (h, w) boolean of the view, of the same aspect ratio. NaN for a map of zeros, or a view so
    small that no pixel lies in the band.
    """
    total = float(values.sum())
    within, share = _band(mask, values.shape) if total > 0 and mask.any() else (values, 0)
    if share == 0:
        return float("nan")
    return float((values * within).sum() / total) / share


@weak_cache  # the channels of a view share its mask
def _band(mask, shape):
    """((h', w') the share of each pixel's object that lies in the band, the band's share of the object's area)."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    box = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    padded = cv2.copyMakeBorder(mask[box].astype(np.uint8), 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
    inward = cv2.distanceTransform(padded, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1]
    band = np.zeros(mask.shape, dtype=bool)
    band[box] = (inward > 0) & (inward <= BAND * len(mask))
    parts = (cv2.resize(image.astype(np.float32), shape[::-1], interpolation=cv2.INTER_AREA) for image in (band, mask))
    along, inside = parts
    within = np.divide(along, inside, out=np.zeros_like(along), where=inside > 0)
    return within, float(band.sum() / mask.sum())


def read_maps(path: str | Path) -> tuple[np.ndarray, np.ndarray, list[Viewpoint], list[str]]:
    """(maps (v, channels, h, w) f4, mask (v, h, w) boolean, viewpoints, channels) of a file of data/SET/conspicuity."""
    arrays = read_arrays(path)
    viewpoints = [parse_viewpoint(name) for name in arrays["viewpoints"]]
    return arrays["maps"].astype("f4"), arrays["mask"], viewpoints, [str(channel) for channel in arrays["channels"]]


def read_view_maps(path: str | Path, mesh: Mesh) -> ViewMaps:
    """The ViewMaps of an object from its file of data/SET/conspicuity."""
    maps, mask, viewpoints, channels = read_maps(path)
    return ViewMaps(mesh, viewpoints, {channel: maps[:, k] for k, channel in enumerate(channels)}, mask)


def parse_viewpoint(name: str) -> Viewpoint:
    """The Viewpoint of a name, for example `az120_el-45`; ValueError for another name."""
    number = r"(-?[\d.]+(?:e-?\d+)?)"
    match = re.fullmatch(rf"az{number}_el{number}(?:_ro{number})?", str(name))
    if match is None:
        raise ValueError(f"{str(name)!r} is not the name of a viewpoint, such as az120_el-45")
    return Viewpoint(*(float(angle) for angle in match.groups(default="0")))
