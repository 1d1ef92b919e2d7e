"""Where a finger goes that follows a contour, and how it holds the array (T4.4.5, T4.4.6)."""

from dataclasses import dataclass

import numpy as np

from stages.kit.mesh import unit

from .frame import CANCELLED

COLLINEAR = 1e-4  # sine of the angle between the two points seen from the centre: below, rounding turns the plane
TIE = 1e-6  # of the length: pieces as long as the longest, but for rounding; the one nearest to the first point wins
KNOT = 1e-9  # of the length: a place so near a knot is at it, and goes on along the segment ahead
HEADING = 1e-3  # sine of the angle between the way and the normal below which the way gives no direction on the array


@dataclass(frozen=True)
class Path:
    """Places of the array along a piece of a cut: positions (frames, 3), axes (frames, 3, 3); the rest as Sequence."""

    positions: np.ndarray
    axes: np.ndarray
    loops: int
    length: float
    share: float


def walk(cutter, plane_points, frames, width):
    """The Path round the longest piece of the cut; `follow` says what is chosen how.

    width: how far to both sides the faces along the contour count for the normal, in units.
    Raises ValueError for three points that make no plane, and for a plane that meets no surface.
    """
    piece, pieces, normal = chosen(cutter, plane_points)
    total = sum(one.length for one in pieces)
    knots = np.append(0.0, np.cumsum(piece.steps))
    along = (_nearest(piece, plane_points[1])[0] + knots[-1] / frames * np.arange(frames)) % knots[-1]
    # The last segment that begins at or before the place; those without length are never chosen. Each contour begins at
    # a knot (a vertex): rounding must not say whether the finger points along the segment ahead or the one behind.
    near = KNOT * knots[-1]
    along = np.where(along + near < knots[-1], along, 0.0)
    segment = np.searchsorted(knots[1:], along + near, side="right")
    ahead = np.roll(piece.points, -1, axis=0) - piece.points
    tangents = unit(ahead[segment])
    positions = piece.points[segment] + np.maximum(along - knots[segment], 0)[:, None] * tangents
    flat = cutter.mesh.face_normals[piece.faces]
    normals = _averaged(flat, piece.steps, along, width, flat[np.minimum(segment, len(flat) - 1)])
    return Path(positions, _axes(normals, tangents, normal), len(pieces), piece.length, piece.length / total)


def chosen(cutter, plane_points):
    """(the piece of the cut that is followed, turned the way it is walked; all pieces; the plane's unit normal)."""
    centre, first, second = plane_points
    normal = _normal(centre, first, second)
    pieces = cutter.cut(centre, normal)
    if not pieces or pieces[0].length <= 0:
        raise ValueError(f"the plane through {_text(centre)}, {_text(first)} and {_text(second)} misses the mesh")
    longest = [piece for piece in pieces if piece.length >= (1 - TIE) * pieces[0].length]
    piece = min(longest, key=lambda one: _nearest(one, first)[1])
    return piece if _area(piece.points, normal) >= 0 else piece.backwards(), pieces, normal


def _normal(centre, first, second):
    a, b = first - centre, second - centre
    size = np.linalg.norm(a) * np.linalg.norm(b)
    across = np.cross(a, b)
    if not size > 0 or np.linalg.norm(across) <= COLLINEAR * size:
        raise ValueError(f"{_text(centre)}, {_text(first)} and {_text(second)} lie on a line or coincide: no plane")
    return unit(across)


def _area(points, normal):
    """Twice the area inside the points, negative where they turn clockwise seen from the tip of the normal."""
    local = points - points[0]
    return float(np.cross(local, np.roll(local, -1, axis=0)).sum(axis=0) @ normal)


def _nearest(piece, place):
    """(how far along the piece its point nearest to the place is, how near it is), in units."""
    starts = piece.points if piece.closed else piece.points[:-1]
    ways = np.roll(piece.points, -1, axis=0)[: len(starts)] - starts
    square = np.einsum("ij,ij->i", ways, ways)
    share = np.einsum("ij,ij->i", place - starts, ways) / np.where(square > 0, square, 1)
    share = np.clip(share, 0, 1)
    away = np.linalg.norm(starts + share[:, None] * ways - place, axis=1)
    nearest = away.argmin()
    return piece.steps[:nearest].sum() + share[nearest] * piece.steps[nearest], away[nearest]


def _averaged(flat, steps, along, width, instead):
    """(frames, 3) unit means of the normals of the segments' faces within `width` of the places, weighed by length.

    Where they cancel out, as on a sheet thinner than the width, it is the normal of the face below (`instead`), and
    where that has none it is +z.
    """
    knots = np.append(0.0, np.cumsum(steps))
    sums = np.vstack([np.zeros(3), np.cumsum(flat * steps[:, None], axis=0)])
    length, width = knots[-1], min(width, knots[-1] / 2)

    def until(s):
        rounds, rest = np.divmod(s, length)
        return rounds[:, None] * sums[-1] + np.stack([np.interp(rest, knots, part) for part in sums.T], axis=1)

    mean = (until(along + width) - until(along - width)) / (2 * width)
    mean = np.where(np.linalg.norm(mean, axis=1, keepdims=True) > CANCELLED, mean, instead)
    return unit(np.where(np.linalg.norm(mean, axis=1, keepdims=True) > CANCELLED, mean, [0.0, 0.0, 1.0]))


def _axes(normals, tangents, plane_normal):
    """(frames, 3, 3) rows right, up, normal: up is the way ahead, as far as it lies in the array."""
    ahead = tangents - np.einsum("ij,ij->i", tangents, normals)[:, None] * normals
    across = np.cross(plane_normal, normals)
    up = unit(np.where(np.linalg.norm(ahead, axis=1, keepdims=True) > HEADING, ahead, across))
    return np.stack([np.cross(up, normals), up, normals], axis=1)


def _text(point):
    return "(" + ", ".join(f"{value:.4g}" for value in point) + ")"
