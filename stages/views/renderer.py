"""Renders a view by the renderer of a given name."""

import sys
from collections.abc import Sequence
from functools import cache

import numpy as np

from stages.kit import Mesh, Viewpoint

from . import gl
from .material import LAMBERT, Material
from .raster import render_raster
from .view import BACKGROUNDS, View

RENDERERS = {"raster": render_raster, "pyrender": gl.render_pyrender}


def render(
    mesh: Mesh,
    viewpoint: Viewpoint,
    size: Sequence[int] = (900, 1200),
    renderer: str = "auto",
    background: str = "black",
    material: Material = LAMBERT,
) -> View:
    """Renders a mesh by the thesis's orthographic camera (T3.1.1, T3.2.6).

    mesh: centred and scaled by stages.meshes.normalise; its vertex colours are used if it has any. size: (rows,
    columns); one unit of the mesh spans 0.954 of the rows. renderer: `raster`, `pyrender` (needs EGL) or `auto`
    (pyrender if EGL is available, else raster, with a message on stderr). background: `black` as in the thesis,
    `grey` or `white`. material: how the surface reflects the light (stages.views.Material), matte by default. A mesh
    without faces gives a view of the background.

    Raises ValueError for a mesh that leaves the frame and for unknown names or sizes, OSError for `pyrender` when no
    EGL context can be created.
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
