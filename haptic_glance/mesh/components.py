"""Connected components of a graph by union-find, compiled by numba; scipy's first builds a sparse matrix."""

import numpy as np

from haptic_glance.base.jit import helper, kernel_of

kernel = kernel_of(__file__)


@kernel
def graph_components(tails: np.ndarray, heads: np.ndarray, count: int) -> tuple[np.ndarray, int]:
    """(labels (count,) i4, number of components) of a graph with edges tails (e,) to heads (e,)."""
    parent = np.empty(count, dtype=np.int64)
    for v in range(count):  # numba compiles np.arange for half as long as all else here
        parent[v] = v
    for edge in range(len(tails)):
        a, b = _root(parent, tails[edge]), _root(parent, heads[edge])
        if a < b:
            parent[b] = a
        else:
            parent[a] = b
    label = np.empty(count, dtype=np.int32)
    found = 0
    for v in range(count):
        root = _root(parent, v)
        if root == v:
            label[v] = found
            found += 1
        else:
            label[v] = label[root]
    return label, found


@helper
def _root(parent, v):
    while parent[v] != v:
        parent[v] = parent[parent[v]]
        v = parent[v]
    return v
