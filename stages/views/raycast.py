"""The renderer that runs on every machine: one embree ray through each pixel of the object's bounding box."""

from functools import lru_cache

import numpy as np

from stages.kit import Mesh, RayScene, Viewpoint
from stages.kit.camera import pixel_rays, project

from .shading import corner_groups, shade
from .view import View, empty_view, pixel_box, round_depth


def render_raycast(mesh: Mesh, viewpoint: Viewpoint, size: tuple[int, int], background: str) -> View:
    """Renders a View (see stages.views.render) by embree rays."""
    view = empty_view(viewpoint, size, background)
    top, left, bottom, right = pixel_box(mesh, viewpoint, size)
    grid = np.meshgrid(np.arange(top, bottom), np.arange(left, right), indexing="ij")
    rows, columns = grid[0].ravel(), grid[1].ravel()
    scene, normals = _prepare(mesh)
    hits = scene.cast(*pixel_rays(rows, columns, viewpoint, size))
    on = np.flatnonzero(hits.hit)
    faces = hits.face[on]
    at = rows[on], columns[on]
    view.face[at] = faces
    view.depth[at] = round_depth(hits.distance[on])
    back = viewpoint.axes[2]
    facing = np.where((mesh.face_crosses @ back < 0)[:, None], -back, back)
    view.rgb[at] = shade(mesh, normals, facing, faces, _weights(mesh, viewpoint, size, faces, *at))
    return view


@lru_cache(maxsize=2)  # views of one mesh are rendered in turn; two, for a mesh and its simplified version
def _prepare(mesh):
    """(RayScene, corner normals (m, 3, 3)), which all views of a mesh share."""
    groups, normals = corner_groups(mesh)
    return RayScene(mesh), normals[groups]


def _weights(mesh, viewpoint, size, faces, rows, columns):
    """(k, 3) barycentric weights of pixels in their faces, linear in image coordinates (orthographic camera)."""
    r, c, _ = project(mesh.vertices, viewpoint, size)
    corners = np.stack([r, c], axis=1)[mesh.faces]
    origin = corners[:, 0]
    b, d = corners[:, 1] - origin, corners[:, 2] - origin
    area = b[:, 0] * d[:, 1] - b[:, 1] * d[:, 0]
    inverse = np.divide(1.0, area, out=np.zeros_like(area), where=np.abs(area) > 1e-12)
    turned = np.stack([d[:, 1], -d[:, 0], -b[:, 1], b[:, 0]], axis=1) * inverse[:, None]
    p, q = rows - origin[faces, 0], columns - origin[faces, 1]
    g = turned[faces]
    # A ray on an edge may hit either face: clipped, so that rounding cannot move the weights outside.
    wb = (g[:, 0] * p + g[:, 1] * q).clip(0, 1)
    wd = np.minimum((g[:, 2] * p + g[:, 3] * q).clip(0, 1), 1 - wb)
    return np.stack([1 - wb - wd, wb, wd], axis=1)
