"""The decorator of this folder's kernels, and vectors of three numbers.

A call of a vector function is compiled in less time than the operators that it stands for.
"""

import numpy as np

from haptic_glance.base.jit import cached_njit, helper

Id = int | np.integer  # of a vertex, half-edge, face or bucket

# Inlined throughout: a call passes seven words for each array, which took as long as the work.
kernel = cached_njit(forceinline=True)  # for arguments of any numeric type

Vector = tuple[float, float, float]


@helper
def point(p: np.ndarray, v: Id) -> Vector:
    """Row v of p (n, 3). numba checks whether an index is negative, unless its type is unsigned."""
    v = np.uint32(v)
    return p[v, 0], p[v, 1], p[v, 2]


@helper
def between(p: np.ndarray, a: Id, b: Id) -> Vector:
    """From row a of p (n, 3) to row b."""
    a, b = np.uint32(a), np.uint32(b)
    return p[b, 0] - p[a, 0], p[b, 1] - p[a, 1], p[b, 2] - p[a, 2]


@helper
def dot(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> float:
    """The inner product of a and b."""
    return ax * bx + ay * by + az * bz


@helper
def cross(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> Vector:
    """The cross product of a and b."""
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
