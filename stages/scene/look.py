"""One object at one level, ray cast through the pixels of one frame."""

from dataclasses import dataclass

import numpy as np

from stages.kit.mesh import unit
from stages.kit.rays import barycentric

LIT = 230  # brightness of a face that looks into the camera
DARK = 0.25  # of it is left on faces seen edge on, or silhouettes would drown in the black around them
LUMA = np.array([0.299, 0.587, 0.114])  # ITU-R BT.601


@dataclass(frozen=True, eq=False)
class Look:
    """Where the rays met the object: pixels (k,) i4 flat ids; depth (k,) f8, metres along the view axis; faces (k,) i4.

    No more than that, since a path holds thousands of looks: `rays_of` gives the places.
    """

    pixels: np.ndarray
    depth: np.ndarray
    faces: np.ndarray


def pixel_box(camera, pose, box=None):
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


def look(level, camera, pose):
    """The Look of a level's mesh."""
    top, bottom, left, right = pixel_box(camera, pose, level.box)
    rows, columns = (grid.ravel() for grid in np.mgrid[top:bottom, left:right])
    world = camera.directions(rows, columns)
    along = world @ pose.turn
    eye = pose.to_mesh(np.array([camera.eye]))
    hits = level.rays.cast(np.broadcast_to(eye, along.shape), along)
    on = np.flatnonzero(hits.hit & (hits.distance > 0))
    depth = hits.distance[on] * pose.scale * (world[on] @ camera.axes[2])
    pixels = rows[on] * camera.size[1] + columns[on]
    return Look(pixels.astype(np.int32), depth, hits.face[on].astype(np.int32))


def rays_of(found, camera, pose):
    """(points (k, 3) of a Look in the mesh's own coordinates, directions (k, 3) of the rays there)."""
    world = camera.directions(*np.divmod(found.pixels, camera.size[1]))
    points = np.array(camera.eye) + world * (found.depth / (world @ camera.axes[2]))[:, None]
    return pose.to_mesh(points), world @ pose.turn


def shade(level, found, camera, pose):
    """rgb (k, 3) f8, 0 to 255, of a Look: Lambert under a light at the camera, smooth across edges below a crease."""
    mesh, (points, along) = level.mesh, rays_of(found, camera, pose)
    groups, normals = level.corners
    weights = np.clip(barycentric(mesh, found.faces, points), 0, 1)
    normal = unit(np.einsum("ij,ijk->ik", weights, normals[groups[found.faces]]))
    facing = np.sign(np.einsum("ij,ij->i", mesh.face_normals[found.faces], along))  # both sides are lit
    cosine = (facing * np.einsum("ij,ij->i", normal, along)).clip(0, 1)
    light = DARK + (1 - DARK) * cosine[:, None]
    if mesh.colors is None:
        return LIT * np.repeat(light, 3, axis=1)
    return np.einsum("ij,ijk->ik", weights, mesh.colors[mesh.faces[found.faces]].astype(np.float64)) * light


def nearest(looks, pixels):
    """(pixels,) which Look is the nearest, -1 where there is none."""
    depth, owner = np.full(pixels, np.inf), np.full(pixels, -1)
    for item, seen in enumerate(looks):
        nearer = seen.depth < depth[seen.pixels]
        depth[seen.pixels[nearer]], owner[seen.pixels[nearer]] = seen.depth[nearer], item
    return owner


def nearest_two(looks, pixels):
    """(first, second, owner), each (pixels,): depth of the nearest Look and of the next, inf where there is none, and
    which Look is the nearest, -1 for none.
    """
    first, second, owner = np.full(pixels, np.inf), np.full(pixels, np.inf), np.full(pixels, -1)
    for item, seen in enumerate(looks):
        before = first[seen.pixels]
        nearer = seen.depth < before
        second[seen.pixels] = np.where(nearer, before, np.minimum(second[seen.pixels], seen.depth))
        first[seen.pixels] = np.where(nearer, seen.depth, before)
        owner[seen.pixels[nearer]] = item
    return first, second, owner
