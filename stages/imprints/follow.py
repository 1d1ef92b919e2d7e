"""Contour following: what the sensor feels along a plane cut through the object's centre (T4.4.5, T4.4.6)."""

from functools import lru_cache

import numpy as np

from .adaptive import adaptive_pitch
from .distances import check_sensor
from .follow_path import chosen, walk
from .press import press_at
from .section import Cutter
from .sequence import Sequence
from .surface import ready

BATCH = 1 << 11  # frames pressed at once: their distances in double precision stay below 20 MB


def follow(mesh_or_surface, plane_points, frames=25, cells=(32, 32), pitch=0.01):
    """The Sequence that the array feels along one contour of an object (T4.4.5, T4.4.6).

    plane_points (3, 3): the object's centre and two points, in units of the mesh; the contour is the cut of the mesh
    by their plane. Of several loops the longest is followed: T4.4.6 sends all planes through the centre "to avoid the
    selection of local contours around object extremities", and the shorter loops are such. `Sequence.loops` and
    `.share` say what was left out. An open line (on a mesh with a rim) is followed as well: at its end the finger is
    lifted and goes on at its beginning.

    The `frames` places are equally spaced along the contour. The thesis does not say where it begins and which way
    round: here at the contour's point nearest to the second of the plane points (the first after the centre), and
    counter-clockwise about the plane's normal, (second - centre) x (third - centre): so towards the third by the
    shorter way. A place on a contour is no vertex: the array's normal is the mean of the unit normals of the faces that
    the contour crosses within one pitch before and behind, each weighed by the length crossed, as T4.3.1 averages the
    faces around a vertex. Interpolated between the averages at the vertices instead, the array would stand askew on
    the large faces of flat sides, in their middle by tens of degrees.

    Row 0 of an imprint is ahead: the array's upright axis is the way along the contour, as a finger that follows a
    contour keeps its heading. So a sequence turns with the object and nothing in it changes, and the frames do not
    spin where the contour passes a pole, as they would with `sensor_axes`; the thesis is silent on this too. The
    array is smaller at saddles, with equally many cells (T4.4.3, `adaptive_pitch`).

    Raises ValueError where the points make no plane, the plane misses the mesh, or there are less than one frame or
    no array.
    """
    found = follow_many(mesh_or_surface, np.asarray(plane_points, dtype=np.float64)[None], frames, cells, pitch)[0]
    if isinstance(found, str):
        raise ValueError(found)
    return found


def follow_many(mesh_or_surface, planes, frames=25, cells=(32, 32), pitch=0.01):
    """[Sequence, or the reason why there is none (str)] for each of the planes (k, 3, 3); pressed in batches.

    Everything else, and errors of what all planes share, as in `follow`.
    """
    surface = ready(mesh_or_surface)
    planes = _check_planes(planes)
    if not frames >= 1 or frames % 1:
        raise ValueError(f"frames must be a whole number from 1, got {frames}")
    cells, pitch, _ = check_sensor(cells, pitch)
    cutter = _cutter(surface.mesh)
    found = [_walk_or_reason(cutter, points, int(frames), pitch) for points in planes]
    at = [i for i, path in enumerate(found) if not isinstance(path, str)]
    step = max(1, BATCH // int(frames))
    for i in range(0, len(at), step):
        paths = [found[j] for j in at[i : i + step]]
        for j, sequence in zip(at[i : i + step], _pressed(surface, paths, cells, pitch), strict=True):
            found[j] = sequence
    return found


def contour(mesh_or_surface, plane_points):
    """The Loop that `follow` follows on the plane of points (3, 3), turned the way it goes; errors as in `follow`."""
    points = _check_planes(np.asarray(plane_points, dtype=np.float64)[None])[0]
    return chosen(_cutter(ready(mesh_or_surface).mesh), points)[0]


def _check_planes(planes):
    planes = np.asarray(planes, dtype=np.float64)
    if planes.ndim != 3 or planes.shape[1:] != (3, 3) or not np.isfinite(planes).all():
        raise ValueError(f"planes must be finite points of shape (k, 3, 3): centre and two points, got {planes.shape}")
    return planes


@lru_cache(maxsize=2)
def _cutter(mesh):
    return Cutter(mesh)


def _walk_or_reason(cutter, points, frames, width):
    try:
        return walk(cutter, points, frames, width)
    except ValueError as error:
        return str(error)


def _pressed(surface, paths, cells, pitch):
    """The Sequences of some Paths, all their frames pressed at once."""
    positions = np.concatenate([path.positions for path in paths])
    axes = np.concatenate([path.axes for path in paths])
    pitches = adaptive_pitch(surface, positions, axes, cells, pitch)
    images = press_at(surface, positions, axes, cells, pitches)
    each = (np.split(part, len(paths)) for part in (images, axes[:, 2], positions, pitches))
    return [Sequence(*parts, path.loops, path.length, path.share) for *parts, path in zip(*each, paths, strict=True)]
