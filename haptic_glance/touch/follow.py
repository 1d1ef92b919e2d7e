"""Follows a contour: the path of the finger, how it holds the array, and what the sensor measures (T4.4.5, T4.4.6).

The contour is a plane section through the object's centre.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.mesh.mesh import Mesh, unit

from .distances import adaptive_distances, check_array
from .press import normalise
from .section import MeshCutter, SectionCurve
from .surface import CANCELLED, Surface, as_surface

COLLINEAR = 1e-4  # sine of the angle between the two points, seen from the centre; below it rounding decides the plane
STRAIGHT = 1e-6  # of the squared length: around a curve that encloses less, rounding would decide the direction
LENGTH_TIE = 1e-6  # of the length: of curves that differ by less the one nearest to the first point is followed
KNOT_TOLERANCE = 1e-9  # of the length: a place this near a knot is at it and continues along the segment ahead
MIN_HEADING = (
    1e-3  # sine of the angle between direction of motion and normal, below which it gives no direction on the array
)


@dataclass(frozen=True)
class ContourPath:
    """Places of the array along a curve: positions (frames, 3), axes (frames, 3, 3); the rest as in Sequence."""

    positions: np.ndarray
    axes: np.ndarray
    loops: int
    length: float
    share: float


def walk(cutter: MeshCutter, plane_points: np.ndarray, frames: int, width: float) -> ContourPath:
    """The ContourPath along the longest curve of the section, as `follow` describes.

    width: the distance to both sides within which faces along the contour count for the normal, in units.
    Raises ValueError for three points that define no plane, and for a plane that misses the surface.
    """
    curve, curves, normal = followed_curve(cutter, plane_points)
    total = sum(piece.length for piece in curves)
    knots = np.append(0.0, np.cumsum(curve.steps))
    arc_lengths = (_nearest(curve, plane_points[1])[0] + knots[-1] / frames * np.arange(frames)) % knots[-1]
    # The last segment that begins at or before the place; one without length is never chosen. Each contour begins at a
    # knot (a vertex): rounding must not decide whether the finger points along the segment ahead or the one behind.
    near = KNOT_TOLERANCE * knots[-1]
    arc_lengths = np.where(arc_lengths + near < knots[-1], arc_lengths, 0.0)
    segment = np.searchsorted(knots[1:], arc_lengths + near, side="right")
    ahead = np.roll(curve.points, -1, axis=0) - curve.points
    tangents = unit(ahead[segment])
    positions = curve.points[segment] + np.maximum(arc_lengths - knots[segment], 0)[:, None] * tangents
    face_normals = cutter.normals(curve, plane_points[0], normal)
    below = face_normals[np.minimum(segment, len(face_normals) - 1)]
    normals = _averaged(face_normals, curve.steps, curve.closed, arc_lengths, width, below)
    return ContourPath(positions, _axes(normals, tangents, normal), len(curves), curve.length, curve.length / total)


def followed_curve(cutter: MeshCutter, plane_points: np.ndarray) -> tuple[SectionCurve, list[SectionCurve], np.ndarray]:
    """(the curve that is followed, in its direction; all curves of the section; the plane's unit normal)."""
    centre, first, second = plane_points
    normal = _normal(centre, first, second)
    curves = cutter.cut(centre, normal)
    if not curves or curves[0].length <= 0:
        raise ValueError(f"the plane through {_text(centre)}, {_text(first)} and {_text(second)} misses the mesh")
    longest = [curve for curve in curves if curve.length >= (1 - LENGTH_TIE) * curves[0].length]
    curve = min(longest, key=lambda candidate: _nearest(candidate, first)[1])
    turn = _area(curve.points, normal)
    if abs(turn) <= STRAIGHT * curve.length**2:  # as on a flat sheet
        turn = (curve.points[-1] - curve.points[0]) @ (second - first)
    return curve if turn >= 0 else curve.backwards(), curves, normal


def _normal(centre, first, second):
    a, b = first - centre, second - centre
    size = np.linalg.norm(a) * np.linalg.norm(b)
    cross = np.cross(a, b)
    if not size > 0 or np.linalg.norm(cross) <= COLLINEAR * size:
        raise ValueError(
            f"{_text(centre)}, {_text(first)} and {_text(second)} lie on a line or coincide, so they define no plane"
        )
    return unit(cross)


def _area(points, normal):
    """Twice the area enclosed by the points, negative if they are clockwise seen from the tip of the normal."""
    local = points - points[0]
    return float(np.cross(local, np.roll(local, -1, axis=0)).sum(axis=0) @ normal)


def _nearest(curve, place):
    """(arc length of the curve's point nearest to the place, its distance from the place), in units."""
    starts = curve.points if curve.closed else curve.points[:-1]
    segments = np.roll(curve.points, -1, axis=0)[: len(starts)] - starts
    square = np.einsum("ij,ij->i", segments, segments)
    share = np.einsum("ij,ij->i", place - starts, segments) / np.where(square > 0, square, 1)
    share = np.clip(share, 0, 1)
    distances = np.linalg.norm(starts + share[:, None] * segments - place, axis=1)
    nearest = distances.argmin()
    return curve.steps[:nearest].sum() + share[nearest] * curve.steps[nearest], distances[nearest]


def _averaged(face_normals, steps, closed, arc_lengths, width, fallback):
    """(frames, 3) unit means of the face normals within `width` of the places, weighted by length.

    Beyond the ends of an open curve nothing counts. Where the normals cancel out, as on a sheet thinner than the width,
    it is the normal of the face below (`fallback`), or +z if that face has no normal.
    """
    knots = np.append(0.0, np.cumsum(steps))
    sums = np.vstack([np.zeros(3), np.cumsum(face_normals * steps[:, None], axis=0)])
    length, width = knots[-1], min(width, knots[-1] / 2)
    begin, end = arc_lengths - width, arc_lengths + width
    if not closed:
        begin, end = np.maximum(begin, 0), np.minimum(end, length)

    def integral(s):
        turns, rest = np.divmod(s, length)
        return turns[:, None] * sums[-1] + np.stack([np.interp(rest, knots, part) for part in sums.T], axis=1)

    mean = (integral(end) - integral(begin)) / (2 * width)
    mean = np.where(np.linalg.norm(mean, axis=1, keepdims=True) > CANCELLED, mean, fallback)
    return unit(np.where(np.linalg.norm(mean, axis=1, keepdims=True) > CANCELLED, mean, [0.0, 0.0, 1.0]))


def _axes(normals, tangents, plane_normal):
    """(frames, 3, 3) rows right, up, normal: up is the direction of motion projected on the array."""
    ahead = tangents - np.einsum("ij,ij->i", tangents, normals)[:, None] * normals
    cross = np.cross(plane_normal, normals)
    up = unit(np.where(np.linalg.norm(ahead, axis=1, keepdims=True) > MIN_HEADING, ahead, cross))
    return np.stack([np.cross(up, normals), up, normals], axis=1)


def _text(point):
    return "(" + ", ".join(f"{value:.4g}" for value in point) + ")"


@dataclass(frozen=True)
class Sequence:
    """The frames of one contour, in the order of motion.

    Attributes
    ----------
    images : (frames, rows, cols) array of float
        Imprints in 0..1, the cutaneous cues.
    normals : (frames, 3) array of float
        Unit normals of the array.
    positions : (frames, 3) array of float
        Centres of the array in units of the mesh; with the normals the kinesthetic cues.
    pitches : (frames,) array of float
        Distance of neighbouring cells, in units of the mesh.
    loops : int
        Number of curves of the section.
    length : float
        Length of the followed curve, in units of the mesh.
    share : float
        That length as a share of the length of all curves.
    """

    images: np.ndarray
    normals: np.ndarray
    positions: np.ndarray
    pitches: np.ndarray
    loops: int
    length: float
    share: float


BATCH = 1 << 11  # frames pressed at once: their distances in double precision take less than 20 MB


def follow(
    mesh_or_surface: Mesh | Surface,
    plane_points: ArrayLike,
    frames: int = 25,
    cells: tuple[int, int] = (32, 32),
    pitch: float = 0.01,
) -> Sequence:
    """Measures along one contour of an object with the array (T4.4.5, T4.4.6).

    Parameters
    ----------
    mesh_or_surface : Mesh, Surface or any input of `as_mesh`
        The object.
    plane_points : (3, 3) array_like
        The object's centre and two points, in units of the mesh. The contour is the section of the mesh by their plane.
    frames : int
        Number of places, equally spaced along the contour.
    cells : tuple of 2 ints
        Rows and columns of the array.
    pitch : float or str
        Distance of neighbouring cells, in units of the mesh. `haptic_glance.follow` takes a share of the object's
        diameter, or a text such as "1mm" together with `unit`, the unit of the mesh's coordinates.

    Returns
    -------
    Sequence
        Imprints, normals and positions in the order of motion.

    Raises
    ------
    ValueError
        If the points define no plane, the plane misses the mesh, frames is less than 1, or cells or pitch are invalid.

    Notes
    -----
    Of several curves the longest is followed: T4.4.6 puts all planes through the centre "to avoid the selection of
    local contours around object extremities", which the shorter curves are. `Sequence.loops` and `.share` state the
    rest. An open curve (on a mesh with boundary edges) is followed as well: at its end the finger is lifted and
    continues at its beginning.

    The thesis gives neither start nor direction. Here the start is the contour's point nearest to the second of the
    plane points (the first after the centre). The direction is counter-clockwise about the plane's normal, (second -
    centre) x (third - centre), so towards the third by the shorter way. A straight contour, as on a flat sheet, leads
    from the second towards the third. A place on a contour is not a vertex: the array's normal is the mean of the unit
    normals of the faces that the contour crosses within one pitch before and behind, weighted by the length crossed
    (along an edge in the plane, of the mean of its faces), as T4.3.1 averages the faces around a vertex. Interpolation
    between the averages at the vertices would tilt the array on the large faces of flat sides, in their middle by tens
    of degrees.

    Row 0 of an imprint is ahead: the array's up axis is the direction of motion, as a finger that follows a contour
    keeps its heading. So a rotation of the object does not change a sequence, if the pitch stays the same (a share of
    the diameter changes with the bounding box, a length such as "1mm" does not). The frames do not spin where the
    contour passes a pole, as they would with `sensor_axes`. The thesis does not say this either. The array is smaller
    at saddles, with the same number of cells (T4.4.3, `adaptive_distances`).

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import follow
    >>> ball = trimesh.creation.icosphere(3, radius=0.5)
    >>> follow(ball, [(0, 0, 0), (0.5, 0, 0), (0, 0.5, 0)], frames=4, cells=(8, 8)).images.shape
    (4, 8, 8)
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
    if not isinstance(frames, int | float | np.number) or not frames >= 1 or frames % 1:
        raise ValueError(f"frames must be a whole number from 1, got {frames}")
    cells, pitch, _ = check_array(cells, pitch)
    cutter = _cutter(surface.mesh)
    outcomes = [_path_or_reason(cutter, points, int(frames), pitch) for points in planes]
    paths, batch = [path for path in outcomes if not isinstance(path, str)], max(1, BATCH // int(frames))
    batches = [paths[i : i + batch] for i in range(0, len(paths), batch)]
    sequences = iter([sequence for part in batches for sequence in _press_paths(surface, part, cells, pitch)])
    return [path if isinstance(path, str) else next(sequences) for path in outcomes]


def contour(mesh_or_surface: Mesh | Surface, plane_points: ArrayLike) -> SectionCurve:
    """The SectionCurve that `follow` follows on the plane of points (3, 3), in its direction; errors as in `follow`."""
    points = _check_planes(np.asarray(plane_points, dtype=np.float64)[None])[0]
    return followed_curve(_cutter(as_surface(mesh_or_surface).mesh), points)[0]


def _check_planes(planes):
    planes = np.asarray(planes, dtype=np.float64)
    if planes.ndim == 3 and planes.shape[1:] == (3, 3) and not np.isfinite(planes).all():
        raise ValueError(f"a plane must be three finite points, got {planes[~np.isfinite(planes).all(axis=2)][0]}")
    if planes.ndim != 3 or planes.shape[1:] != (3, 3):
        raise ValueError(
            f"a plane must be three finite points of shape (3, 3), its centre first; got {planes.shape[1:]}"
        )
    return planes


_cutter = lru_cache(maxsize=2)(MeshCutter)


def _path_or_reason(cutter, points, frames, width):
    try:
        return walk(cutter, points, frames, width)
    except ValueError as error:
        return str(error)


def _press_paths(surface, paths, cells, pitch):
    """The Sequences of some ContourPaths, all their frames pressed at once."""
    positions = np.concatenate([path.positions for path in paths])
    axes = np.concatenate([path.axes for path in paths])
    pitches, cell_distances = adaptive_distances(surface, positions, axes, cells, pitch)
    images = normalise(cell_distances, pitches)
    sequences, start = [], 0
    for path in paths:
        span = slice(start, start := start + len(path.positions))
        parts = images[span], axes[span, 2], positions[span], pitches[span]
        sequences.append(Sequence(*parts, path.loops, path.length, path.share))
    return sequences
