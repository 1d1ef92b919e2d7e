"""Renders a view by the renderer of a given name.

`raster` runs on every machine: it draws each face into a depth buffer, in double precision.
"""

import sys
from collections.abc import Sequence
from functools import cache, lru_cache

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from ..camera import Viewpoint, project
from . import gl
from .kernels import rasterise, shade_pixels
from .shading import GREY, corner_groups
from .view import BACKGROUNDS, LAMBERT, Material, View, empty_view, pixel_box, round_depth

NO_COLORS = np.zeros((0, 3), dtype=np.uint8)
_normals = lru_cache(maxsize=2)(corner_groups)  # all views of a mesh share them; two, for a mesh and its simplified one


def render_raster(mesh: Mesh, viewpoint: Viewpoint, size: tuple[int, int], background: str, material: Material) -> View:
    """Renders a View (see haptic_glance.look.views.render) face by face."""
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


RENDERERS = {"raster": render_raster, "pyrender": gl.render_pyrender}


def render(
    mesh: Mesh,
    viewpoint: Viewpoint,
    size: Sequence[int] = (900, 1200),
    renderer: str = "raster",
    background: str = "black",
    material: Material = LAMBERT,
) -> View:
    """Renders a mesh by the thesis's orthographic camera (T3.1.1, T3.2.6).

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The normalised mesh (`normalise`); its vertex colours are used if it has any.
    viewpoint : Viewpoint
        Place of the camera.
    size : sequence of 2 ints
        Rows and columns; one unit of the mesh spans 0.954 of the rows.
    renderer : {"raster", "pyrender", "auto"}
        `raster` gives the same bytes on every machine. `pyrender` needs EGL. `auto`: pyrender if EGL is available, else
        raster, with a message on stderr.
    background : {"black", "grey", "white"}
        Black as in the thesis.
    material : Material
        How the surface reflects the light (`haptic_glance.look.views.Material`), matte by default.

    Returns
    -------
    View
        Colours, depth and visible faces; of a mesh without faces the background.

    Raises
    ------
    ValueError
        For a mesh that leaves the frame, and for unknown names or sizes.
    OSError
        For `pyrender` when no EGL context can be created.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import Viewpoint, normalise, render
    >>> render(normalise(trimesh.creation.box()), Viewpoint(30, 20), size=(90, 120)).rgb.shape
    (90, 120, 3)
    """
    if background not in BACKGROUNDS:
        raise ValueError(f"unknown background {background!r}: choose one of {', '.join(BACKGROUNDS)}")
    size = tuple(size)
    if len(size) != 2 or not all(isinstance(side, int | np.integer) and side > 0 for side in size):
        raise ValueError(f"size must be two positive whole numbers (rows, columns), got {size}")
    return RENDERERS[resolve_renderer(renderer)](mesh, viewpoint, size, background, material)


def resolve_renderer(renderer: str) -> str:
    """The name of the renderer on this machine: `auto` becomes pyrender or raster. ValueError for an unknown name."""
    if renderer == "auto":
        return _available()
    if renderer not in RENDERERS:
        raise ValueError(f"unknown renderer {renderer!r}: choose auto or one of {', '.join(RENDERERS)}")
    return renderer


@cache
def _available():
    if not gl.egl_error():
        return "pyrender"
    print(f"views: EGL is not available ({gl.egl_error()}): using the renderer raster", file=sys.stderr)
    return "raster"
