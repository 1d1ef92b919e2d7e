"""Shapes whose pictures are known, inside the frame of the camera."""

import numpy as np
import pytest
import trimesh

from haptic_glance.look.views import gl
from haptic_glance.mesh.mesh import Mesh


def as_mesh(shape, colors=None):
    return Mesh(shape.vertices, shape.faces, colors)


@pytest.fixture(scope="session")
def shapes():
    """Name -> Mesh: smooth, sharp, hollow, open and coloured."""
    sphere = trimesh.creation.icosphere(subdivisions=4, radius=0.5)
    torus = trimesh.creation.torus(0.3, 0.15, major_sections=64, minor_sections=32)
    cube = trimesh.creation.box(extents=[0.5, 0.5, 0.5])
    lower = sphere.faces[sphere.triangles_center[:, 2] < 0]
    return {
        "sphere": as_mesh(sphere),
        "torus": as_mesh(torus),
        "cube": as_mesh(cube),
        "bowl": Mesh(sphere.vertices, lower),
        "coloured": as_mesh(torus, np.clip((torus.vertices + 0.5) * 255, 0, 255).astype(np.uint8)),
    }


@pytest.fixture(params=["raster", "pyrender"])
def renderer(request):
    """Each renderer that can run here."""
    if request.param == "pyrender" and gl.egl_error():
        pytest.skip(f"no EGL context on this machine: {gl.egl_error()}")
    return request.param
