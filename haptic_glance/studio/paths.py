"""Paths of the array over an object, drawn by clicks: through places, or around the object."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from haptic_glance.mesh.mesh import unit
from haptic_glance.mesh.rays import RayScene, barycentric
from haptic_glance.touch import Surface, contour, follow
from haptic_glance.touch.surface import mean_vertex_normals

from .specimen import Hit

FRAMES = 25  # T4.4.5
FINE = 241  # points of a path as it is drawn: every tenth is a frame of 25
JUMP = 0.08  # units between neighbouring points, half an array: the surface ends there
ABOVE = 0.1  # units above the straight line between two places from which the surface is looked for, at least


@dataclass(frozen=True)
class Path:
    """The poses of the array, frame by frame: positions (k, 3), axes (k, 3, 3), pitches (k,) units.

    line (m, 3): the way as it is drawn; note: how long it is, for the person.
    """

    positions: np.ndarray
    axes: np.ndarray
    pitches: np.ndarray
    line: np.ndarray
    note: str


def around(surface: Surface, first: Hit, second: Hit, frames: int, cells: tuple[int, int], pitch: float) -> Path:
    """The contour in the plane through the object's middle and two places, as haptic_glance.touch.follow walks it
    (T4.4.6).

    Raises ValueError where the three lie on a line.
    """
    plane = np.stack([np.zeros(3), first.position, second.position])
    sequence, curve = follow(surface, plane, frames, cells, pitch), contour(surface, plane)
    line = np.concatenate([curve.points, curve.points[: int(curve.closed)]])
    ahead = np.roll(sequence.positions, -1, axis=0) - sequence.positions
    share = "" if sequence.loops == 1 else f", the longest of {sequence.loops} curves of this plane"
    note = f"once around, {sequence.length:.2f} times the object's size{share}"
    return Path(sequence.positions, _axes(sequence.normals, ahead), sequence.pitches, line, note)


def through(rays: RayScene, places: Sequence[Hit], frames: int, pitch: float) -> Path:
    """Over the surface from place to place, along the lines that a person sees between them.

    Raises ValueError for fewer than two places, and where the path leaves the mesh, with the places between which.
    """
    if len(places) < 2:
        raise ValueError("a path needs two places at least: click another one")
    corners = np.stack([hit.position for hit in places])
    knots = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1)))
    if not knots[-1] > 0:
        raise ValueError("the places are one and the same: click another one")
    outward = np.stack([hit.normal for hit in places])
    line, faces, normals = _on_surface(rays, corners, outward, knots, np.linspace(0, knots[-1], FINE))
    stops = np.rint(np.linspace(0, FINE - 1, frames)).astype(int)
    normals = _normals(rays.mesh, line[stops], faces[stops], normals[stops])
    axes, positions = _axes(normals, np.gradient(line[stops], axis=0)), line[stops]
    note = f"{len(places)} places, {knots[-1]:.2f} times the object's size"
    return Path(positions, axes, np.full(frames, pitch), line, note)


def _on_surface(rays, corners, outward, knots, along):
    """(positions (k, 3), faces (k,), normals (k, 3)) below the lines between the corners, at lengths along (k,)."""
    leg = np.clip(np.searchsorted(knots, along, side="right") - 1, 0, len(corners) - 2)
    share = ((along - knots[leg]) / np.maximum(np.diff(knots)[leg], 1e-12))[:, None]
    line = corners[leg] * (1 - share) + corners[leg + 1] * share
    normals = unit(outward[leg] * (1 - share) + outward[leg + 1] * share)
    height = np.maximum(np.diff(knots)[leg], ABOVE)
    hits = rays.cast(line + height[:, None] * normals, -normals)
    positions = line + (height - np.minimum(hits.distance, 2 * height))[:, None] * normals
    steps = np.linalg.norm(np.diff(positions, axis=0, prepend=positions[:1]), axis=1)
    is_jump = steps > JUMP + knots[-1] / len(along)  # a ray that misses ends at least ABOVE below the line
    if is_jump.any():
        at = int(leg[is_jump.argmax()])
        raise ValueError(f"the path leaves the mesh between places {at + 1} and {at + 2}: click a place between them")
    return positions, hits.face, normals


def _normals(mesh, positions, faces, fallback):
    """Normals of the array between the corners of each face, which turn smoothly along the path."""
    weights = np.clip(barycentric(mesh, faces, positions), 0, 1)
    mean = np.einsum("ij,ijk->ik", weights, mean_vertex_normals(mesh)[mesh.faces[faces]])
    outward = np.einsum("ij,ij->i", mean, mesh.face_normals[faces]) > 0
    return unit(np.where(outward[:, None], mean, fallback))


def _axes(normals, ahead):
    """(k, 3, 3) rows right, up, normal: up is the direction of motion on the array."""
    up = ahead - np.einsum("ij,ij->i", ahead, normals)[:, None] * normals
    still = np.linalg.norm(up, axis=1, keepdims=True) < 1e-9
    up = unit(np.where(still, np.cross(normals, [0.1, 0.2, 1.0]), up))
    return np.stack([np.cross(up, normals), up, normals], axis=1)
