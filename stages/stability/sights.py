"""A look at a mesh under conditions: other light, other background, a smaller image."""

import numpy as np

from stages.conspicuity import Sight, conspicuity
from stages.conspicuity.channels import SHARE, coverage
from stages.kit import camera
from stages.kit.rays import barycentric
from stages.views import TWELVE, View, render
from stages.views.shading import corner_groups, shade

LEAST = 9  # rows and columns; below it there is nothing to see


def look(mesh, channels, conditions, size):
    """The Sight of a normalised mesh from the twelve viewpoints under these Conditions; None without channels.

    size: (rows, columns) of the views when conditions.rows is one; maps have a quarter of them. Drawn by the ray
    caster, which gives the same bytes on every machine.
    """
    if not channels:
        return None
    size = tuple(max(round(conditions.rows * side), LEAST) for side in size)
    share = tuple(max(side // SHARE, 1) for side in size)
    normals = corner_normals(mesh) if conditions.light else None
    found, masks = [], []
    for viewpoint in TWELVE:
        view = render(mesh, viewpoint, size, "raycast")
        if conditions.light:
            view = relit(mesh, view, conditions.light, normals)
        view.rgb[~view.mask] = round(255 * conditions.background)
        found.append(conspicuity(mesh, view, channels, share, conditions.filled))
        masks.append(coverage(view.mask, share))
    maps = {channel: np.stack([maps[channel] for maps in found]) for channel in channels}
    return Sight(mesh, TWELVE, maps, np.stack(masks))


def corner_normals(mesh):
    """(m, 3, 3): the normal that shades each corner of each face."""
    groups, normals = corner_groups(mesh)
    return normals[groups]


def relit(mesh, view, degrees, normals):
    """The view with its light so many degrees off the camera, up and to the left; without cast shadows.

    The renderers know the head light alone, so the pixels are shaded anew by the renderers' own `shade`. normals:
    corner_normals(mesh). At 0 degrees the colours come out as rendered.
    """
    right, up, back = view.viewpoint.axes
    angle = np.radians(degrees)
    light = np.cos(angle) * back + np.sin(angle) * (up - right) / np.sqrt(2)
    rows, columns = np.nonzero(view.mask)
    origins, directions = camera.pixel_rays(rows, columns, view.viewpoint, view.mask.shape)
    faces = view.face[rows, columns].astype(np.int64)
    points = origins + view.depth[rows, columns, None].astype(np.float64) * directions
    weights = barycentric(mesh, faces, points).clip(0, 1)
    facing = np.where((mesh.face_crosses @ back < 0)[:, None], -light, light)
    rgb = view.rgb.copy()
    rgb[rows, columns] = shade(mesh, normals, facing, faces, weights)
    return View(rgb, view.depth, view.face, view.viewpoint)
