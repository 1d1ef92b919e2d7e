"""Levels chosen by errors that were rendered beforehand: the fewest faces at a mean displacement, planned within 1 ms.

Each object is rendered alone, once, at each level, from directions all around. On a screen, the displacements of its
pixels add up to the same sum times the cube of the pixels that one unit covers: a displacement grows with these pixels,
and the number of displaced pixels with their square. The mean of this cube over points of the surface, 0 for those out
of the frame, accounts for perspective and for objects that are seen in part. Planning a frame then means looking sums
up. The levels with the least faces + price * displacement have the fewest faces of all at their own mean displacement
(Everett 1963).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import unit

from .camera import Camera, Pose
from .chain import Level
from .frames import Frames, Plan

DIRECTIONS = 32  # views of an object, about 36 degrees apart
ROWS = 64  # of a view
POINTS = 256  # of a surface, by which its part in the frame is known to some hundredths
NEAR = 0.05  # metres from the eye: nothing is drawn larger than there


@dataclass(frozen=True)
class Profile:
    """The errors of an object's levels: directions (d, 3) from the object to the eye, sums (d, l), and points (p, 3).

    sums: the displacement between a level and the finest one, integrated over both pictures, in the mesh's unit cubed.
    points: of its surface, evenly by area.
    """

    directions: np.ndarray
    sums: np.ndarray
    points: np.ndarray


def profile(chain: Sequence[Level], rows: int = ROWS) -> Profile:
    """Renders the errors of an object's levels once, without perspective, from directions all around.

    Parameters
    ----------
    chain : sequence of Level
        The levels, finest first, from `build_lod_chain`.
    rows : int
        Pixels a side of each picture.

    Returns
    -------
    Profile
        The errors by direction, for `by_profiles`.
    """
    low, high = chain[0].box
    middle, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
    views = _spread(DIRECTIONS)
    places = (np.arange(rows) + 0.5) / rows * 2 - 1
    across, up = (radius * grid.ravel()[:, None] for grid in np.meshgrid(places, places))
    starts, along = [], []
    for view in views:
        right = unit(np.cross(view, np.eye(3)[np.abs(view).argmin()]))
        starts.append(middle + 2 * radius * view + across * right + up * np.cross(view, right))
        along.append(np.broadcast_to(-view, starts[-1].shape))
    origins, rays = np.concatenate(starts), np.concatenate(along)
    area = (2 * radius / rows) ** 2
    hits = [_hits(level, origins, rays) for level in chain]
    sums = np.zeros((DIRECTIONS, len(chain)))
    for k, level in enumerate(chain[1:], start=1):
        for (ray, points), target in ((hits[0], level), (hits[k], chain[0])):
            distances = target.surface.nearest(points)[0]
            sums[:, k] += area * np.bincount(ray // rows**2, distances, DIRECTIONS)
    return Profile(views, sums, chain[0].surface.sample(POINTS, rng(0, "profile"))[0])


def by_profiles(frames: Frames, chains: Sequence[Sequence[Level]], profiles: Sequence[Profile], price: float) -> Plan:
    """Plans the levels of each frame by itself, by errors rendered beforehand.

    Parameters
    ----------
    frames : Frames
        The frames of a scene.
    chains : sequence of sequence of Level
        Levels of each object.
    profiles : sequence of Profile
        Profile of each object, from `profile`.
    price : float
        Faces that one pixel displaced by one pixel is worth, above 0.

    Returns
    -------
    Plan
        The level of each object in each frame.

    Raises
    ------
    ValueError
        For a price that is not above 0.
    """
    if not price > 0:
        raise ValueError(f"the price is {price} faces: give a number above 0")
    columns = []
    for item, (chain, record) in enumerate(zip(chains, profiles, strict=True)):
        pose = frames.poses[item]
        directions = np.array([camera.eye for camera in frames.scene.cameras]) - pose.corners().mean(axis=0)
        views = np.argmax(unit(directions) @ pose.turn @ record.directions.T, axis=1)
        cubes = [_cube(camera, pose, record.points) for camera in frames.scene.cameras]
        columns.append(cheapest_at(chain, record.sums[views] * np.array(cubes)[:, None], price))
    return Plan(np.stack(columns, axis=1), chains, frames)


def rendered_sums(frames: Frames, chains: Sequence[Sequence[Level]]) -> list[np.ndarray]:
    """[(f, l)] of each object: the displacements of each level in each frame, summed over its pixels in both pictures.

    Every level is rendered in every frame: the errors that a planner with any amount of time would know.
    """
    tables = []
    for item, chain in enumerate(chains):
        full, sums = frames.full[item], np.zeros((len(frames.in_view), len(chain)))
        where = [(int(frame), k) for frame in np.flatnonzero(frames.in_view[:, item]) for k in range(1, len(chain))]
        frames.measure([(frame, item, full, chain[k]) for frame, k in where])
        for frame, k in where:
            sums[frame, k] = sum(
                frames.moved(frame, item, *pair).sum() for pair in ((full, chain[k]), (chain[k], full))
            )
        tables.append(sums)
    return tables


def by_sums(frames: Frames, chains: Sequence[Sequence[Level]], sums: Sequence[np.ndarray], price: float) -> Plan:
    """The Plan by displacements (f, l) of each object, as `rendered_sums` gives them."""
    columns = [cheapest_at(chain, table, price) for chain, table in zip(chains, sums, strict=True)]
    return Plan(np.stack(columns, axis=1), chains, frames)


def cheapest_at(chain: Sequence[Level], sums: np.ndarray, price: float) -> np.ndarray:
    """(f,) the level with the least faces + price * sums (f, l) in each frame."""
    return np.argmin([level.faces for level in chain] + price * sums, axis=1)


def _cube(camera: Camera, pose: Pose, points: np.ndarray) -> float:
    """The cube of the pixels that a unit of the mesh covers: mean over points (p, 3), 0 for those out of the frame."""
    rows, columns, depth = camera.project(pose.to_world(points))  # NaN behind the camera, which is in no frame
    height, width = camera.size
    inside = (abs(rows - (height - 1) / 2) <= height / 2) & (abs(columns - (width - 1) / 2) <= width / 2)
    return float(np.mean(inside * (pose.scale * camera.focal / np.maximum(depth, NEAR)) ** 3))


def _hits(level: Level, origins: np.ndarray, rays: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(numbers (k,) of the rays that hit a level, points (k, 3) that they hit)."""
    hits = level.rays.cast(origins, rays)
    ray_ids = np.flatnonzero(hits.hit)
    return ray_ids, origins[ray_ids] + rays[ray_ids] * hits.distance[ray_ids, None]


def _spread(count: int) -> np.ndarray:
    """(count, 3) directions evenly all around: a Fibonacci lattice (Swinbank and Purser 2006)."""
    up = 1 - (2 * np.arange(count) + 1) / count
    turn = np.pi * (3 - np.sqrt(5)) * np.arange(count)
    flat = np.sqrt(1 - up**2)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), up], axis=1)
