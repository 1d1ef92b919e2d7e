"""The renderer that runs on every machine: each face drawn into a depth buffer, in double precision."""

from functools import lru_cache

import numpy as np

from stages.kit import Mesh, Viewpoint
from stages.kit.camera import project

from .kernels import rasterise, shade_pixels
from .material import Material
from .shading import GREY, corner_groups
from .view import View, empty_view, pixel_box, round_depth

NO_COLORS = np.zeros((0, 3), dtype=np.uint8)


def render_raster(mesh: Mesh, viewpoint: Viewpoint, size: tuple[int, int], background: str, material: Material) -> View:
    """Renders a View (see stages.views.render) face by face."""
    view = empty_view(viewpoint, size, background)
    places = np.stack(project(mesh.vertices, viewpoint, size))
    corners, (top, left, bottom, right) = places.T, pixel_box(places.take(mesh.used, axis=1), size)
    box = slice(top, bottom), slice(left, right)
    face, depth = view.face[box], np.full((bottom - top, right - left), np.inf)
    rasterise(corners, mesh.faces, top, left, face, depth)
    view.depth[box] = round_depth(depth)
    colors = NO_COLORS if mesh.colors is None else mesh.colors
    light = float(GREY), material.values, viewpoint.axes[2]
    shade_pixels(
        corners, mesh.faces, mesh.face_crosses, *_normals(mesh), colors, *light, top, left, face, view.rgb[box]
    )
    return view


@lru_cache(maxsize=2)  # views of one mesh are rendered in turn; two, for a mesh and its simplified version
def _normals(mesh):
    """corner_groups, which all views of a mesh share."""
    return corner_groups(mesh)
