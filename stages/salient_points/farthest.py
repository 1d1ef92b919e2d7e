"""Points spread as far apart as possible: how much of a detector's merit is its even spread (T3.2.3)."""

import numpy as np

from stages.kit import Mesh
from stages.weights.svm_pixels import select_far_points

from .options import Detection, Options


class FarthestPoints:
    """Vertices chosen one after another, each the farthest from all before it (Gonzalez 1985)."""

    channels = ()
    required_weights = None

    def find(self, mesh: Mesh, _sight: None, _options: Options, count: int | None = None) -> Detection:
        """A Detection of vertices; the first is the one farthest from the centre, ties go by position."""
        if count is None:
            raise ValueError("farthest points have no threshold to stop at: give a count")
        used = np.flatnonzero(mesh.vertex_normals.any(axis=1))
        positions = mesh.vertices[used].round(9)
        order = used[np.lexsort((*positions.T[::-1], -(positions**2).sum(axis=1)))]
        return Detection(order[select_far_points(mesh.vertices[order], count)], None, None)
