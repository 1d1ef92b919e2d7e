"""Blind touch: points by chance, the yardstick of every method (T4.2.4)."""

import numpy as np

from stages.conspicuity.project import nearest_corners
from stages.kit.rng import rng

from .options import Found

ROUNDS = 100  # of drawing anew; only a mesh with hardly more vertices than points wanted needs more than one


class BlindTouch:
    """Vertices nearest to points drawn uniformly over the area, so that finely meshed places get no more of them."""

    channels = ()  # it does not look
    learned = None

    def find(self, mesh, _sight, options, count=None):
        """Found distinct vertices in the order drawn."""
        if count is None:
            raise ValueError("random points have no threshold to stop at: give a count")
        return Found(random_vertices(mesh, count, rng(options.seed, options.name)), None, None)


def random_vertices(mesh, count, generator):
    """(k,) distinct vertices; k < count only on a mesh that has no more within reach. ValueError for no area."""
    total, count = mesh.face_areas.sum(), min(count, len(np.unique(mesh.faces)))
    if not total > 0:
        raise ValueError("the mesh has no area to draw points from")
    drawn = np.zeros(0, dtype=np.int64)
    for _ in range(ROUNDS):
        drawn = np.r_[drawn, _draw(mesh, mesh.face_areas / total, 4 * count, generator)]
        drawn = drawn[np.sort(np.unique(drawn, return_index=True)[1])]
        if len(drawn) >= count:
            break
    return drawn[:count]


def _draw(mesh, share, size, generator):
    faces = generator.choice(len(share), size=size, p=share)
    u, v = np.sqrt(generator.random(size)), generator.random(size)
    parts = np.stack([1 - u, u * (1 - v), u * v], axis=1)  # uniform in a triangle: Osada et al. 2002, eq. 1
    positions = np.einsum("ki,kij->kj", parts, mesh.vertices[mesh.faces[faces]])
    return nearest_corners(mesh, faces, positions)
