"""Where a finger goes that follows a contour, and how it holds the array (T4.4.5, T4.4.6)."""

from dataclasses import dataclass

import numpy as np

from stages.kit.mesh import unit

from .frame import CANCELLED
from .section import MeshCutter, SectionCurve

COLLINEAR = 1e-4  # sine of the angle between the two points, seen from the centre; below it rounding decides the plane
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
    total = sum(one.length for one in curves)
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
    face_normals = cutter.mesh.face_normals[curve.faces]
    normals = _averaged(
        face_normals, curve.steps, arc_lengths, width, face_normals[np.minimum(segment, len(face_normals) - 1)]
    )
    return ContourPath(positions, _axes(normals, tangents, normal), len(curves), curve.length, curve.length / total)


def followed_curve(cutter: MeshCutter, plane_points: np.ndarray) -> tuple[SectionCurve, list[SectionCurve], np.ndarray]:
    """(the curve that is followed, in its direction; all curves of the section; the plane's unit normal)."""
    centre, first, second = plane_points
    normal = _normal(centre, first, second)
    curves = cutter.cut(centre, normal)
    if not curves or curves[0].length <= 0:
        raise ValueError(f"the plane through {_text(centre)}, {_text(first)} and {_text(second)} misses the mesh")
    longest = [curve for curve in curves if curve.length >= (1 - LENGTH_TIE) * curves[0].length]
    curve = min(longest, key=lambda one: _nearest(one, first)[1])
    return curve if _area(curve.points, normal) >= 0 else curve.backwards(), curves, normal


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


def _averaged(face_normals, steps, arc_lengths, width, fallback):
    """(frames, 3) unit means of the face normals within `width` of the places, weighted by length.

    Where they cancel out, as on a sheet thinner than the width, it is the normal of the face below (`fallback`), or +z
    if that face has no normal.
    """
    knots = np.append(0.0, np.cumsum(steps))
    sums = np.vstack([np.zeros(3), np.cumsum(face_normals * steps[:, None], axis=0)])
    length, width = knots[-1], min(width, knots[-1] / 2)

    def integral(s):
        turns, rest = np.divmod(s, length)
        return turns[:, None] * sums[-1] + np.stack([np.interp(rest, knots, part) for part in sums.T], axis=1)

    mean = (integral(arc_lengths + width) - integral(arc_lengths - width)) / (2 * width)
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
