"""Points that only keep away from each other: how much of a detector's worth is its even spread (T3.2.3)."""

import numpy as np

from stages.weights.svm_pixels import select_far_points

from .options import Found


class FarthestPoints:
    """Vertices chosen one after the other, each the farthest from all before (Gonzalez 1985)."""

    channels = ()
    learned = None

    def find(self, mesh, _sight, _options, count=None):
        """Found vertices; the first is the one farthest from the centre, equally far ones go by position."""
        if count is None:
            raise ValueError("farthest points have no threshold to stop at: give a count")
        used = mesh.vertex_normals.any(axis=1).nonzero()[0]
        places = mesh.vertices[used].round(9)
        order = used[np.lexsort((*places.T[::-1], -(places**2).sum(axis=1)))]
        return Found(order[select_far_points(mesh.vertices[order], count)], None, None)
