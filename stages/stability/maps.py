"""Conspicuity maps of a mesh under other conditions: light, background, image size."""

from collections.abc import Sequence

import numpy as np

from haptic_glance.look import camera
from haptic_glance.look.channels import ViewMaps, conspicuity
from haptic_glance.look.channels.channels import REDUCTION, mask_at_size
from haptic_glance.look.views import TWELVE, View, render
from haptic_glance.look.views.shading import corner_groups, shade
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import barycentric

from .perturbations import Conditions

LEAST_SIDE = 9  # rows and columns of the smallest image


def maps_under_conditions(
    mesh: Mesh, channels: Sequence[str], conditions: Conditions, size: Sequence[int]
) -> ViewMaps | None:
    """The conspicuity maps of a normalised mesh from the twelve viewpoints under `conditions`; None without channels.

    size: (rows, columns) of the views when conditions.rows is 1; maps have a quarter of them. The renderer
    `raster` gives the same bytes on every machine.
    """
    if not channels:
        return None
    size = tuple(max(round(conditions.rows * side), LEAST_SIDE) for side in size)
    share = max(size[0] // REDUCTION, 1), max(size[1] // REDUCTION, 1)
    normals = corner_normals(mesh) if conditions.light else np.zeros((0, 3, 3))
    found, masks = [], []
    for viewpoint in TWELVE:
        view = render(mesh, viewpoint, size, "raster")
        if conditions.light:
            view = relit(mesh, view, conditions.light, normals)
        view.rgb[~view.mask] = round(255 * conditions.background)
        found.append(conspicuity(mesh, view, channels, share, conditions.filled))
        masks.append(mask_at_size(view.mask, share))
    maps = {channel: np.stack([maps[channel] for maps in found]) for channel in channels}
    return ViewMaps(mesh, TWELVE, maps, np.stack(masks))


def corner_normals(mesh: Mesh) -> np.ndarray:
    """(m, 3, 3): the shading normal at each corner of each face."""
    groups, normals = corner_groups(mesh)
    return normals[groups]


def relit(mesh: Mesh, view: View, degrees: float, normals: np.ndarray) -> View:
    """The view with its light `degrees` off the camera, up and to the left, without cast shadows.

    The renderers have a head light alone, so the pixels are shaded again by the renderers' own `shade`. normals:
    corner_normals(mesh). At 0 degrees the colours are as rendered.
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
