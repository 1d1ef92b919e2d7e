"""The distance to the centre of the face that a ray meets, as T4.3.1 prints it, in place of the exact hit."""

import numpy as np

from haptic_glance.mesh.files import MeshLike
from haptic_glance.mesh.rays import RayScene
from haptic_glance.touch.surface import LIFT, Surface


class FaceCentres(Surface):
    """A Surface whose distances are those to the centres of the faces under the cells (T4.3.1, T figure 4.7).

    `press`, `distances` and `follow` take it in place of a mesh. The distance is P1 - P2 along the normal, of a cell P1
    and the centre P2 of the face, so that imprints follow the triangulation.
    """

    def __init__(self, mesh: MeshLike) -> None:
        super().__init__(mesh)
        self._scene = RayScene(self.mesh)
        self._centres: np.ndarray = self.mesh.vertices[self.mesh.faces].mean(axis=1)

    def measure(self, centres: np.ndarray, axes: np.ndarray, cells: tuple[int, int], pitches: np.ndarray) -> np.ndarray:
        """As `Surface.measure`, to the centres of the faces; a cell without a face keeps its distance."""
        found = super().measure(centres, axes, cells, pitches)
        normals = np.broadcast_to(axes[:, None, None, 2], (*found.shape, 3))
        places = cell_places(centres, axes, cells, pitches)
        hit = np.isfinite(found)
        down = np.where(found[hit] >= 0, 1.0, -1.0)[:, None] * normals[hit]
        origins = places[hit] - found[hit][:, None] * normals[hit] + 10 * LIFT * self.mesh.diagonal * down
        face = self._scene.cast(origins, -down).face
        reached = face >= 0
        exact = found[hit]
        exact[reached] = np.einsum("ij,ij->i", places[hit] - self._centres[face], normals[hit])[reached]
        found[hit] = exact
        return found


def cell_places(centres: np.ndarray, axes: np.ndarray, cells: tuple[int, int], pitches: np.ndarray) -> np.ndarray:
    """(k, rows, cols, 3) where the cells of arrays are: row 0 at the top, column 0 at the left."""
    up, right = np.meshgrid(*(np.arange(count) - (count - 1) / 2 for count in cells), indexing="ij")
    steps = np.stack([right, -up], axis=-1) * pitches[:, None, None, None]
    return centres[:, None, None] + np.einsum("krcd,kde->krce", steps, axes[:, :2])
