"""The file of one object's points, and the conspicuity maps that it is made of."""

import re

import numpy as np

from stages.kit import Viewpoint
from stages.kit.files import read_arrays, write_arrays

from .sight import Sight


def write_found(path, found):
    """Writes dict method -> Found: METHOD.points, METHOD.strong and, where there is one, METHOD.saliency (n,) f4."""
    arrays = {}
    for method, result in found.items():
        arrays[f"{method}.points"] = result.points.astype(np.int64)
        arrays[f"{method}.strong"] = np.int64(result.strong)
        if result.saliency is not None:
            arrays[f"{method}.saliency"] = result.saliency.astype(np.float32)
    write_arrays(path, **arrays)


def read_points(path):
    """dict method -> (k,) i8 vertex ids, most salient first."""
    return _read(path, "points")


def read_strong_points(path):
    """dict method -> (k',) i8: the leading ones that pass the thesis's 90 % threshold (T3.2.5)."""
    strong = _read(path, "strong")
    return {method: points[: strong[method]] for method, points in read_points(path).items()}


def read_saliency(path):
    """dict method -> (n,) f4 in 0..1 per vertex; methods that have none (random) are absent."""
    return _read(path, "saliency")


def _read(path, kind):
    stored = read_arrays(path)
    return {key.rpartition(".")[0]: stored[key] for key in stored if key.endswith(f".{kind}")}


def read_sight(path, mesh):
    """The Sight of one object from its file of data/conspicuity."""
    stored = read_arrays(path)
    viewpoints = [viewpoint_named(name) for name in stored["viewpoints"]]
    maps = {str(channel): stored["maps"][:, k] for k, channel in enumerate(stored["channels"])}
    return Sight(mesh, viewpoints, maps, stored["mask"])


def viewpoint_named(name):
    """The Viewpoint that has this name, for example `az120_el-45`."""
    number = r"(-?[\d.]+(?:e-?\d+)?)"
    match = re.fullmatch(rf"az{number}_el{number}(?:_ro{number})?", str(name))
    if match is None:
        raise ValueError(f"{str(name)!r} is no viewpoint's name: expected one like az120_el-45")
    return Viewpoint(*(float(angle) for angle in match.groups(default="0")))
