"""Random points (the thesis's blind touch), the baseline of every method (T4.2.4)."""

from dataclasses import dataclass

import numpy as np

from stages.conspicuity.project import nearest_corners
from stages.kit import Mesh
from stages.kit.rng import rng
from stages.kit.surface_samples import points_in_faces

from .options import Detection, Options

ROUNDS = 100  # of drawing; only a mesh with hardly more vertices than points asked for needs more than one


@dataclass(frozen=True)
class RandomPoints:
    """Vertices nearest to points drawn uniformly by area, so that finely meshed regions get no more of them.

    draw: the number of the draw; what is concluded from blind touch should not hang on one.
    """

    draw: int = 1
    channels = ()
    required_weights = None

    def find(self, mesh: Mesh, _sight: None, options: Options, count: int | None = None) -> Detection:
        """A Detection of distinct vertices in the order drawn."""
        if count is None:
            raise ValueError("random points have no threshold to stop at: give a count")
        name = options.name if self.draw == 1 else f"{options.name}, draw {self.draw}"
        return Detection(random_vertices(mesh, count, rng(options.seed, name)), None, None)


def random_vertices(mesh: Mesh, count: int, generator: np.random.Generator) -> np.ndarray:
    """(k,) distinct vertices; fewer than count only on tiny meshes. Raises ValueError without area."""
    total, count = mesh.face_areas.sum(), min(count, len(mesh.used))
    if not total > 0:
        raise ValueError("the mesh has no area to draw points from")
    drawn = np.zeros(0, dtype=np.int64)
    for _ in range(ROUNDS):
        drawn = np.r_[drawn, _draw(mesh, mesh.face_areas / total, 4 * count, generator)]
        drawn = drawn[np.sort(np.unique(drawn, return_index=True)[1])]
        if len(drawn) >= count:
            break
    return drawn[:count]


def _draw(mesh, probabilities, size, generator):
    faces = generator.choice(len(probabilities), size=size, p=probabilities)
    positions, _ = points_in_faces(mesh, faces, generator.random((2, size)))
    return nearest_corners(mesh, faces, positions)
