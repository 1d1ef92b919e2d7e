"""Files of imprints, data/SET/imprints/NAME.npz, and the distance to the centre of the face that a ray meets.

T4.3.1 prints the centre in place of the exact hit.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays, write_arrays
from haptic_glance.mesh.files import MeshLike
from haptic_glance.mesh.rays import RayScene
from haptic_glance.touch.surface import LIFT, Surface

PARTS = ("images", "vertices", "positions", "pitch")


@dataclass(frozen=True)
class Imprints:
    """The imprints of one object at the points of one method, in the order of the points.

    images (k, rows, cols) f4 in 0..1, vertices (k,) i8 ids in the mesh, positions (k, 3) f4 in units of the mesh,
    pitch: units between neighbouring cells.
    """

    images: np.ndarray
    vertices: np.ndarray
    positions: np.ndarray
    pitch: float

    @property
    def width(self) -> float:
        """The longer side of the array, in units of the mesh."""
        return max(self.images.shape[1:]) * self.pitch


def write_imprints(path: str | Path, imprints: dict[str, Imprints]) -> None:
    """Writes {method: Imprints} as the arrays METHOD.images, .vertices, .positions and .pitch."""
    arrays = {}
    for method in sorted(imprints):
        entry = imprints[method]
        arrays[f"{method}.images"] = entry.images.astype(np.float32)
        arrays[f"{method}.vertices"] = entry.vertices.astype(np.int64)
        arrays[f"{method}.positions"] = entry.positions.astype(np.float32)
        arrays[f"{method}.pitch"] = np.float64(entry.pitch)
    write_arrays(path, **arrays)


def read_imprints(path: str | Path) -> dict[str, Imprints]:
    """{method: Imprints} of one object, the methods in alphabetical order."""
    arrays, imprints = read_arrays(path), {}
    for method in sorted({key.rpartition(".")[0] for key in arrays}):
        *places, pitch = (arrays[f"{method}.{part}"] for part in PARTS)
        imprints[method] = Imprints(*places, pitch=np.float64(pitch))  # stays double beside f4 positions
    return imprints


def read_images(path: Path) -> dict[str, np.ndarray]:
    """{method: (k, rows, cols) imprints in 0..1} of one object."""
    return {method: imprints.images for method, imprints in read_imprints(path).items()}


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
        distances = super().measure(centres, axes, cells, pitches)
        normals = np.broadcast_to(axes[:, None, None, 2], (*distances.shape, 3))
        places = cell_places(centres, axes, cells, pitches)
        hit = np.isfinite(distances)
        down = np.where(distances[hit] >= 0, 1.0, -1.0)[:, None] * normals[hit]
        origins = places[hit] - distances[hit][:, None] * normals[hit] + 10 * LIFT * self.mesh.diagonal * down
        face = self._scene.cast(origins, -down).face
        has_face = face >= 0
        exact = distances[hit]
        exact[has_face] = np.einsum("ij,ij->i", places[hit] - self._centres[face], normals[hit])[has_face]
        distances[hit] = exact
        return distances


def cell_places(centres: np.ndarray, axes: np.ndarray, cells: tuple[int, int], pitches: np.ndarray) -> np.ndarray:
    """(k, rows, cols, 3) where the cells of arrays are: row 0 at the top, column 0 at the left."""
    up, right = np.meshgrid(*(np.arange(count) - (count - 1) / 2 for count in cells), indexing="ij")
    steps = np.stack([right, -up], axis=-1) * pitches[:, None, None, None]
    return centres[:, None, None] + np.einsum("krcd,kde->krce", steps, axes[:, :2])
