"""The file of one object's points."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.look.points.options import Detection


def write_points(path: Path, found: Mapping[str, Detection]) -> None:
    """Writes dict method -> Detection: METHOD.points, METHOD.strong and, if any, METHOD.saliency (n,) f4."""
    arrays = {}
    for method, result in found.items():
        arrays[f"{method}.points"] = result.points.astype(np.int64)
        arrays[f"{method}.strong"] = np.int64(len(result.points) if result.strong is None else result.strong)
        if result.saliency is not None:
            arrays[f"{method}.saliency"] = result.saliency.astype(np.float32)
    write_arrays(path, **arrays)


def read_points(path: Path) -> dict[str, np.ndarray]:
    """dict method -> (k,) i8 vertex ids, most salient first."""
    return _read(path, "points")


def read_strong_points(path: Path) -> dict[str, np.ndarray]:
    """dict method -> (k',) i8: the leading ones that pass the method's own threshold (T3.2.5)."""
    strong = _read(path, "strong")
    return {method: points[: strong[method]] for method, points in read_points(path).items()}


def read_saliency(path: Path) -> dict[str, np.ndarray]:
    """dict method -> (n,) f4 in 0..1 per vertex; methods without one (random, farthest) are absent."""
    return _read(path, "saliency")


def _read(path, kind):
    stored = read_arrays(path)
    return {key.rpartition(".")[0]: stored[key] for key in stored if key.endswith(f".{kind}")}
