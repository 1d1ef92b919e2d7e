"""Reads the file with the maps of one object."""

import re
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays
from haptic_glance.look.camera import Viewpoint
from haptic_glance.look.channels.view_maps import ViewMaps
from haptic_glance.mesh.mesh import Mesh


def read_maps(path: str | Path) -> tuple[np.ndarray, np.ndarray, list[Viewpoint], list[str]]:
    """(maps (v, channels, h, w) f4, mask (v, h, w) boolean, viewpoints, channels) of a file of data/SET/conspicuity."""
    stored = read_arrays(path)
    viewpoints = [parse_viewpoint(name) for name in stored["viewpoints"]]
    return stored["maps"].astype("f4"), stored["mask"], viewpoints, [str(channel) for channel in stored["channels"]]


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
