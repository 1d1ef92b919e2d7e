"""Warm-up before time is measured: the first touch of a process loads or compiles machine code."""

import functools

import numpy as np

from haptic_glance.mesh.mesh import Mesh

from .kernels.faces import ORDER
from .kernels.measure import BELOW_TAXELS, FIRST_BELOW, MEASURE, PRESS
from .press import press


@functools.cache
def warm_up() -> None:
    """Touches a tetrahedron, the first time it is called in a process."""
    for kernel in (ORDER, MEASURE, FIRST_BELOW, PRESS, BELOW_TAXELS):
        kernel.compile_always()
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    press(Mesh(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])), 0)
