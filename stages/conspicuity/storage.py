"""The file of one object's maps."""

import re

from stages.kit import Viewpoint
from stages.kit.files import read_arrays

from .sight import Sight


def read_maps(path):
    """(maps (v, channels, h, w) f4, mask (v, h, w) boolean, viewpoints, channels) of a file of data/conspicuity."""
    stored = read_arrays(path)
    viewpoints = [viewpoint_named(name) for name in stored["viewpoints"]]
    return stored["maps"].astype("f4"), stored["mask"], viewpoints, [str(channel) for channel in stored["channels"]]


def read_sight(path, mesh):
    """The Sight of one object from its file of data/conspicuity."""
    maps, mask, viewpoints, channels = read_maps(path)
    return Sight(mesh, viewpoints, {channel: maps[:, k] for k, channel in enumerate(channels)}, mask)


def viewpoint_named(name):
    """The Viewpoint that has this name, for example `az120_el-45`."""
    number = r"(-?[\d.]+(?:e-?\d+)?)"
    match = re.fullmatch(rf"az{number}_el{number}(?:_ro{number})?", str(name))
    if match is None:
        raise ValueError(f"{str(name)!r} is no viewpoint's name: expected one like az120_el-45")
    return Viewpoint(*(float(angle) for angle in match.groups(default="0")))
