"""The door to the renderers."""

import sys
from functools import cache

import numpy as np

from . import gl
from .raycast import render_raycast
from .view import BACKGROUNDS

RENDERERS = {"raycast": render_raycast, "pyrender": gl.render_pyrender}


def render(mesh, viewpoint, size=(900, 1200), renderer="auto", background="black"):
    """Looks at a mesh through the thesis's orthographic camera (T3.1.1, T3.2.6) and returns a View.

    mesh: a Mesh that stages.meshes.normalise has centred and scaled; its vertex colours are used where it has them.
    viewpoint: a Viewpoint. size: (rows, columns); the unit of the mesh spans 0.954 of the rows. renderer: `raycast`,
    `pyrender` (needs EGL) or `auto` (pyrender where EGL is, else raycast, which is said once). background: `black` as
    in the thesis, `grey` or `white`. A mesh without faces gives a view of nothing.

    Raises ValueError for a mesh that leaves the frame and for unknown names or sizes, OSError for `pyrender`
    where no EGL context can be made.
    """
    if background not in BACKGROUNDS:
        raise ValueError(f"unknown background {background!r}: choose one of {', '.join(BACKGROUNDS)}")
    size = tuple(size)
    if len(size) != 2 or not all(isinstance(side, int | np.integer) and side > 0 for side in size):
        raise ValueError(f"size must be two positive whole numbers (rows, columns), got {size}")
    return RENDERERS[choose(renderer)](mesh, viewpoint, size, background)


def choose(renderer):
    """The name of the renderer that `renderer` means on this machine: `auto` becomes pyrender or raycast."""
    if renderer == "auto":
        return _best()
    if renderer not in RENDERERS:
        raise ValueError(f"unknown renderer {renderer!r}: choose auto or one of {', '.join(RENDERERS)}")
    return renderer


@cache
def _best():
    if not gl.missing():
        return "pyrender"
    print(f"views: no EGL here ({gl.missing()}), so the ray caster draws", file=sys.stderr)
    return "raycast"
