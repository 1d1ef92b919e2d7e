"""Contour following: what the sensor measures along a plane section through the object's centre (T4.4.5, T4.4.6)."""

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from stages.kit import Mesh

from .adaptive import adaptive_distances
from .distances import check_array
from .follow_path import followed_curve, walk
from .press import normalise
from .section import MeshCutter, SectionCurve
from .sequence import Sequence
from .surface import Surface, as_surface

BATCH = 1 << 11  # frames pressed at once: their distances in double precision take less than 20 MB


def follow(
    mesh_or_surface: Mesh | Surface,
    plane_points: ArrayLike,
    frames: int = 25,
    cells: tuple[int, int] = (32, 32),
    pitch: float = 0.01,
) -> Sequence:
    """The Sequence that the array measures along one contour of an object (T4.4.5, T4.4.6).

    plane_points (3, 3): the object's centre and two points, in units of the mesh; the contour is the
    section of the mesh by their plane. Of several curves the longest is followed: T4.4.6 puts all planes through the
    centre "to avoid the selection of local contours around object extremities", which the shorter curves are.
    `Sequence.loops` and `.share` tell what was left out. An open curve (on a mesh with boundary edges) is followed as
    well: at its end the finger is lifted and continues at its beginning.

    The `frames` places are equally spaced along the contour. The thesis gives neither start nor direction. Here the
    start is the contour's point nearest to the second of the plane points (the first after the centre). The direction
    is counter-clockwise about the plane's normal, (second - centre) x (third - centre), so towards the third by the
    shorter way. A place on a contour is not a vertex: the array's normal is the mean of the unit normals of the faces
    that the contour crosses within one pitch before and behind, weighted by the length crossed, as T4.3.1 averages the
    faces around a vertex. Interpolation between the averages at the vertices would tilt the array on the large faces of
    flat sides, in their middle by tens of degrees.

    Row 0 of an imprint is ahead: the array's up axis is the direction of motion, as a finger that follows a contour
    keeps its heading. So a rotation of the object does not change a sequence, and the frames do not spin where the
    contour passes a pole, as they would with `sensor_axes`. The thesis does not say this either. The array is smaller
    at saddles, with the same number of cells (T4.4.3, `adaptive_distances`).

    Raises ValueError if the points define no plane, the plane misses the mesh, frames is less than 1, or cells or pitch
    are invalid.
    """
    results = follow_many(mesh_or_surface, np.asarray(plane_points, dtype=np.float64)[None], frames, cells, pitch)[0]
    if isinstance(results, str):
        raise ValueError(results)
    return results


def follow_many(
    mesh_or_surface: Mesh | Surface,
    planes: ArrayLike,
    frames: int = 25,
    cells: tuple[int, int] = (32, 32),
    pitch: float = 0.01,
) -> list[Sequence | str]:
    """[Sequence, or the reason why there is none (str)] for each of the planes (k, 3, 3).

    Other parameters, and errors that concern all planes, as in `follow`. Imprints are computed in batches.
    """
    surface = as_surface(mesh_or_surface)
    planes = _check_planes(planes)
    if not frames >= 1 or frames % 1:
        raise ValueError(f"frames must be a whole number from 1, got {frames}")
    cells, pitch, _ = check_array(cells, pitch)
    cutter = _cutter(surface.mesh)
    found = [_path_or_reason(cutter, points, int(frames), pitch) for points in planes]
    paths, batch = [path for path in found if not isinstance(path, str)], max(1, BATCH // int(frames))
    batches = [paths[i : i + batch] for i in range(0, len(paths), batch)]
    sequences = iter([one for part in batches for one in _press_paths(surface, part, cells, pitch)])
    return [path if isinstance(path, str) else next(sequences) for path in found]


def contour(mesh_or_surface: Mesh | Surface, plane_points: ArrayLike) -> SectionCurve:
    """The SectionCurve that `follow` follows on the plane of points (3, 3), in its direction; errors as in `follow`."""
    points = _check_planes(np.asarray(plane_points, dtype=np.float64)[None])[0]
    return followed_curve(_cutter(as_surface(mesh_or_surface).mesh), points)[0]


def _check_planes(planes):
    planes = np.asarray(planes, dtype=np.float64)
    if planes.ndim != 3 or planes.shape[1:] != (3, 3) or not np.isfinite(planes).all():
        raise ValueError(f"planes must be finite points of shape (k, 3, 3): centre and two points, got {planes.shape}")
    return planes


@lru_cache(maxsize=2)
def _cutter(mesh):
    return MeshCutter(mesh)


def _path_or_reason(cutter, points, frames, width):
    try:
        return walk(cutter, points, frames, width)
    except ValueError as error:
        return str(error)


def _press_paths(surface, paths, cells, pitch):
    """The Sequences of some ContourPaths, all their frames pressed at once."""
    positions = np.concatenate([path.positions for path in paths])
    axes = np.concatenate([path.axes for path in paths])
    pitches, measured = adaptive_distances(surface, positions, axes, cells, pitch)
    images = normalise(measured, pitches)
    found, start = [], 0
    for path in paths:
        own = slice(start, start := start + len(path.positions))
        parts = images[own], axes[own, 2], positions[own], pitches[own]
        found.append(Sequence(*parts, path.loops, path.length, path.share))
    return found
