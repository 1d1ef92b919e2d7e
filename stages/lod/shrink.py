"""Smaller neighbourhoods where the target is too low for all of them, the least salient first."""

from bisect import bisect_left
from collections.abc import Iterator

import numpy as np

from stages.kit import Mesh

from .feasibility import InfeasibleTarget, Keep, Rings, check_keep, check_rings, smallest_feasible

LOWER = 0.8  # of the target, at each further try


def shrunk_rings(mesh: Mesh, faces: int, keep: Keep, rings: Rings = 3, free_borders: bool = False) -> np.ndarray:
    """(k,) i8 rings, none larger than given, with which `faces` faces are feasible; -1 where a vertex is not kept.

    keep: vertex ids, most salient first. rings: one number, or (k,) per kept vertex. free_borders: as of `simplify`.
    From the least salient vertex to the most salient, each gives up one ring, in rounds until none has a ring left;
    then, from the least salient on, they are not kept. It stops at the first step at which the target is feasible: of
    two points with equal neighbourhoods the more salient one never gets the smaller, and one step less would be
    infeasible. The thesis has no such rule; its meshes are distorted at such targets (T3.1.5).

    Raises InfeasibleTarget when the target is too low even with nothing kept.
    """
    keep = check_keep(mesh, keep)
    rings = check_rings(keep, rings)
    order = _order(rings)

    def after(steps):
        return rings - np.bincount(order[:steps], minlength=len(rings))

    def feasible(steps):
        return smallest_feasible(mesh, keep, after(steps), free_borders) <= faces

    if feasible(0):
        return rings
    steps = bisect_left(range(len(order) + 1), True, lo=1, key=feasible)
    if steps > len(order):
        raise InfeasibleTarget(faces, smallest_feasible(mesh, free_borders=free_borders))
    return after(steps)


def shrinking_rings(
    mesh: Mesh, faces: int, keep: Keep, rings: Rings = 3, free_borders: bool = False
) -> Iterator[np.ndarray]:
    """Yields `shrunk_rings` for the target, then for ever lower ones, at last with nothing kept.

    For a backend that finds no sound mesh although the count is feasible.
    """
    rings, target = check_rings(check_keep(mesh, keep), rings), faces
    while True:
        try:
            found = shrunk_rings(mesh, target, keep, rings, free_borders)
        except InfeasibleTarget:
            found = np.full_like(rings, -1)
        yield found
        if (found < 0).all():
            return
        target = int(LOWER * target)


def _order(rings):
    """(s,) the kept vertex that loses a ring at each step: in rounds, then the vertices themselves."""
    vertex = np.repeat(np.arange(len(rings)), rings + 1)
    taken = np.arange(len(vertex)) - np.repeat(np.cumsum(rings + 1) - (rings + 1), rings + 1)
    final = rings.max(initial=0)
    rounds = np.where(taken == rings[vertex], final, taken)
    return vertex[np.lexsort((-vertex, rounds))]
