"""One object at one level, ray cast through the pixels of one frame."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from stages.kit.mesh import unit
from stages.kit.rays import barycentric

from .camera import Camera
from .lod_chain import Level
from .place import Box, Pose

LIT = 230  # brightness of a face that points at the camera
DARK = 0.25  # of it is left on faces seen edge-on, or silhouettes would vanish in the black background
LUMA = np.array([0.299, 0.587, 0.114])  # ITU-R BT.601


@dataclass(frozen=True, eq=False)
class Rendering:
    """Where the rays hit the object: pixels (k,) i4 flat ids; depth (k,) f8, metres along the view axis; faces (k,) i4.

    No more, since a path has thousands of renderings: `rays_of` gives the positions.
    """

    pixels: np.ndarray
    depth: np.ndarray
    faces: np.ndarray


def pixel_box(camera: Camera, pose: Pose, box: Box | None = None) -> tuple[int, int, int, int]:
    """(top, bottom, left, right) of the pixels that a box in the mesh's own coordinates covers, the object's own if
    None; the ends exclusive, empty ones have bottom <= top. The whole screen where the box reaches behind the camera.
    """
    h, w = camera.size
    rows, columns, depth = camera.project(pose.corners(box))
    if depth.max() <= 0:
        return 0, 0, 0, 0
    if depth.min() <= 0:
        return 0, h, 0, w
    rows, columns = rows.clip(-1, h), columns.clip(-1, w)
    return (
        int(max(np.ceil(rows.min()), 0)), int(min(np.floor(rows.max()) + 1, h)),
        int(max(np.ceil(columns.min()), 0)), int(min(np.floor(columns.max()) + 1, w)),
    )  # fmt: skip


def render_level(level: Level, camera: Camera, pose: Pose) -> Rendering:
    """The Rendering of a level's mesh."""
    top, bottom, left, right = pixel_box(camera, pose, level.box)
    rows, columns = (grid.ravel() for grid in np.mgrid[top:bottom, left:right])
    world = camera.directions(rows, columns)
    along = world @ pose.turn
    eye = pose.to_mesh(np.array([camera.eye]))
    hits = level.rays.cast(np.broadcast_to(eye, along.shape), along)
    on = np.flatnonzero(hits.hit & (hits.distance > 0))
    depth = hits.distance[on] * pose.scale * (world[on] @ camera.axes[2])
    pixels = rows[on] * camera.size[1] + columns[on]
    return Rendering(pixels.astype(np.int32), depth, hits.face[on].astype(np.int32))


def rays_of(rendering: Rendering, camera: Camera, pose: Pose) -> tuple[np.ndarray, np.ndarray]:
    """(points (k, 3) of a Rendering in the mesh's own coordinates, directions (k, 3) of the rays there)."""
    rows, columns = np.divmod(rendering.pixels, camera.size[1])
    world = camera.directions(rows, columns)
    points = np.array(camera.eye) + world * (rendering.depth / (world @ camera.axes[2]))[:, None]
    return pose.to_mesh(points), world @ pose.turn


def shade(level: Level, rendering: Rendering, camera: Camera, pose: Pose) -> np.ndarray:
    """rgb (k, 3) f8, 0 to 255, of a Rendering: Lambert, with a light at the camera, smooth across edges but creases."""
    mesh, (points, along) = level.mesh, rays_of(rendering, camera, pose)
    groups, normals = level.corners
    weights = np.clip(barycentric(mesh, rendering.faces, points), 0, 1)
    normal = unit(np.einsum("ij,ijk->ik", weights, normals[groups[rendering.faces]]))
    facing = np.sign(np.einsum("ij,ij->i", mesh.face_normals[rendering.faces], along))  # both sides are lit
    cosine = (facing * np.einsum("ij,ij->i", normal, along)).clip(0, 1)
    light = DARK + (1 - DARK) * cosine[:, None]
    if mesh.colors is None:
        return LIT * np.repeat(light, 3, axis=1)
    return np.einsum("ij,ijk->ik", weights, mesh.colors[mesh.faces[rendering.faces]].astype(np.float64)) * light


def nearest(renderings: Sequence[Rendering], pixels: int) -> np.ndarray:
    """(pixels,) the index of the nearest Rendering, -1 where there is none."""
    depth, owner = np.full(pixels, np.inf), np.full(pixels, -1)
    for item, seen in enumerate(renderings):
        nearer = seen.depth < depth[seen.pixels]
        depth[seen.pixels[nearer]], owner[seen.pixels[nearer]] = seen.depth[nearer], item
    return owner


def nearest_two(renderings: Sequence[Rendering], pixels: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(first, second, owner), each (pixels,): depth of the nearest Rendering and of the next, inf where there is none,
    and the index of the nearest, -1 for none.
    """
    first, second, owner = np.full(pixels, np.inf), np.full(pixels, np.inf), np.full(pixels, -1)
    for item, seen in enumerate(renderings):
        before = first[seen.pixels]
        nearer = seen.depth < before
        second[seen.pixels] = np.where(nearer, before, np.minimum(second[seen.pixels], seen.depth))
        first[seen.pixels] = np.where(nearer, seen.depth, before)
        owner[seen.pixels[nearer]] = item
    return first, second, owner
