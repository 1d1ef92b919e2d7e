"""Renders an object at one level by ray casting, and compares frames: structural errors and displacements."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from haptic_glance.base.similarity import WINDOW, ssim_map
from haptic_glance.mesh.mesh import unit
from haptic_glance.mesh.rays import barycentric

from ..perceptual import ssim_error
from .camera import Box, Camera, Pose
from .chain import Level

if TYPE_CHECKING:
    from .frames import Frames  # which imports this module

LIT = 230  # brightness of a face that points at the camera
DARK = 0.25  # of it is left on faces seen edge-on, or silhouettes would vanish in the black background
LUMA = np.array([0.299, 0.587, 0.114])  # ITU-R BT.601


@dataclass(frozen=True, eq=False)
class Rendering:
    """Hits of rays on the object: pixels (k,) i4 flat ids; depth (k,) f8, metres along the view axis; faces (k,) i4.

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
    ray_ids = np.flatnonzero(hits.hit & (hits.distance > 0))
    depth = hits.distance[ray_ids] * pose.scale * (world[ray_ids] @ camera.axes[2])
    pixels = rows[ray_ids] * camera.size[1] + columns[ray_ids]
    return Rendering(pixels.astype(np.int32), depth, hits.face[ray_ids].astype(np.int32))


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


def nearest_two(renderings: Sequence[Rendering], pixels: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(first, second, owner), each (pixels,): depth of the nearest Rendering and of the next, inf where there is none,
    and the index of the nearest, -1 for none.
    """
    first, second, owner = np.full(pixels, np.inf), np.full(pixels, np.inf), np.full(pixels, -1)
    for item, rendering in enumerate(renderings):
        before = first[rendering.pixels]
        nearer = rendering.depth < before
        second[rendering.pixels] = np.where(nearer, before, np.minimum(second[rendering.pixels], rendering.depth))
        first[rendering.pixels] = np.where(nearer, rendering.depth, before)
        owner[rendering.pixels[nearer]] = item
    return first, second, owner


def shaded(frames: "Frames", frame: int, levels: Sequence[Level], only: int | None = None) -> np.ndarray:
    """(h, w, 3) f8 rgb, 0 to 255, of a frame with one level per object.

    only: an object, outside of whose box the picture may be incomplete.
    """
    h, w = frames.scene.cameras[frame].size
    image, depth = np.zeros((h * w, 3)), np.full(h * w, np.inf)
    for item, level in enumerate(levels):
        if only is not None and not _overlap(frames, frame, only, item):
            continue
        rendering = frames.rendering(frame, item, level)
        nearer = rendering.depth < depth[rendering.pixels]
        pixels = rendering.pixels[nearer]
        depth[pixels], image[pixels] = rendering.depth[nearer], frames.colors(frame, item, level)[nearer]
    return image.reshape(h, w, 3)


def picture(frames: "Frames", frame: int, levels: Sequence[Level], only: int | None = None) -> np.ndarray:
    """(h, w) f8 luminance, 0 to 255, of a frame; see `shaded`."""
    return shaded(frames, frame, levels, only) @ LUMA


def picture_error(frames: "Frames", frame: int, levels: Sequence[Level]) -> float:
    """1 - SSIM of a frame (Wang et al. 2004, T [63]) against the full one; the border of 5 pixels is left out."""
    return ssim_error(picture(frames, frame, frames.full), picture(frames, frame, levels))


def structure_lost(frames: "Frames", frame: int, item: int, first: Level, second: Level) -> float:
    """1 - SSIM between an object at two levels, the others at full detail: see `structures_lost`."""
    levels, pictures, visible = list(frames.full), [], []
    for level in (first, second):
        levels[item] = level
        pictures.append(picture(frames, frame, levels, only=item))
        visible.append(frames.rendering(frame, item, level).pixels[frames.visible(frame, item, level)])
    return _lost(frames, frame, item, pictures[0], pictures[1], np.union1d(visible[0], visible[1]))


def structures_lost(frames: "Frames", frame: int, levels: Sequence[Level]) -> np.ndarray:
    """(o,) mean of 1 - SSIM against the full frame, over the pixels that show each object in either picture.

    Pixels at the border of the screen count: their window sees the picture mirrored there.
    """
    before, after = picture(frames, frame, frames.full), picture(frames, frame, levels)
    owners = [frames.owners(frame, side) for side in (frames.full, levels)]
    regions = [np.flatnonzero((owners[0] == item) | (owners[1] == item)) for item in range(len(levels))]
    return np.array([_lost(frames, frame, item, before, after, pixels) for item, pixels in enumerate(regions)])


def displacement_picture(frames: "Frames", frame: int, levels: Sequence[Level]) -> np.ndarray:
    """(h, w) f4 displacement in pixels of what a frame with these levels shows, NaN where it shows nothing."""
    owner = frames.owners(frame, levels)
    image = np.full(owner.shape, np.nan, np.float32)
    for item, level in enumerate(levels):
        pixels = frames.rendering(frame, item, level).pixels
        visible = owner[pixels] == item
        image[pixels[visible]] = frames.displacements(frame, item, level)[visible]
    return image.reshape(frames.scene.cameras[frame].size)


def _lost(frames, frame, item, before, after, pixels):
    """Mean of 1 - SSIM of two pictures over pixels of an object; outside of its box they may be incomplete."""
    if not len(pixels):
        return 0.0
    box = _padded(frames, frame, item)
    dissimilarity = np.zeros(before.shape)
    dissimilarity[box] = 1 - ssim_map(before[box], after[box])
    return float(dissimilarity.ravel()[pixels].mean())


def _padded(frames, frame, item):
    """The object's box padded by the window on all sides, within the screen."""
    h, w = frames.scene.cameras[frame].size
    top, bottom, left, right = frames.boxes[frame][item]
    rows = slice(max(min(top, h - WINDOW) - WINDOW, 0), min(max(bottom, WINDOW) + WINDOW, h))
    return rows, slice(max(min(left, w - WINDOW) - WINDOW, 0), min(max(right, WINDOW) + WINDOW, w))


def _overlap(frames, frame, first, second):
    (rows, columns), (top, bottom, left, right) = _padded(frames, frame, first), frames.boxes[frame][second]
    return rows.start < bottom and top < rows.stop and columns.start < right and left < columns.stop
