"""Connected components of a graph by union-find, compiled by numba; scipy's first builds a sparse matrix."""

import numpy as np

from haptic_glance.base.jit import cached_njit, helper

kernel = cached_njit()


def graph_components(tails: np.ndarray, heads: np.ndarray, count: int) -> tuple[np.ndarray, int]:
    """(labels (count,) i4, number of components) of a graph with edges tails (e,) to heads (e,)."""
    label = np.empty(count, dtype=np.int32)
    return label, _join(tails, heads, np.arange(count), label)


@kernel
def _join(tails, heads, parent, label):
    """Fills the labels and returns the number of components. parent: 0, 1, 2, ..."""
    for edge in range(len(tails)):
        a, b = _root(parent, tails[edge]), _root(parent, heads[edge])
        if a < b:
            parent[b] = a
        else:
            parent[a] = b
    count = 0
    for v in range(len(label)):
        root = _root(parent, v)
        if root == v:
            label[v] = count
            count += 1
        else:
            label[v] = label[root]
    return count


@helper
def _root(parent, v):
    while parent[v] != v:
        parent[v] = parent[parent[v]]
        v = parent[v]
    return v
