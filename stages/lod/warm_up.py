"""A first call before seconds are measured, since it loads compiled code."""

import functools

import numpy as np
import trimesh

from haptic_glance.lod.errors import metro
from haptic_glance.lod.simplify import BACKEND, simplify
from haptic_glance.mesh.mesh import Mesh

FACES = 200  # of 1,280: few enough that every step of the backends runs


@functools.cache
def warm_up(backend: str = BACKEND) -> None:
    """Simplifies a small ball and measures it, once per process and backend."""
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.5)
    mesh = Mesh(ball.vertices, ball.faces)
    metro(mesh, simplify(mesh, FACES, [0], 1, backend, shrink=True), samples=100)
    simplify(mesh, FACES, backend=backend, weights=np.linspace(0, 1, len(mesh.vertices)))
