"""Points and vectors of three numbers: a call is compiled in less time than the operators that it stands for."""

import numpy as np

from .jit import Id, helper

Vector = tuple[float, float, float]


@helper
def point(p: np.ndarray, v: Id) -> Vector:
    """Row v of p (n, 3)."""
    return p[v, 0], p[v, 1], p[v, 2]


@helper
def between(p: np.ndarray, a: Id, b: Id) -> Vector:
    """From row a of p (n, 3) to row b."""
    return p[b, 0] - p[a, 0], p[b, 1] - p[a, 1], p[b, 2] - p[a, 2]


@helper
def dot(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> float:
    """The inner product of a and b."""
    return ax * bx + ay * by + az * bz


@helper
def cross(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> Vector:
    """The cross product of a and b."""
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
