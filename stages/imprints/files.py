"""The files of the stage: data/SET/imprints/NAME.npz."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays, write_arrays

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
        one = imprints[method]
        arrays[f"{method}.images"] = one.images.astype(np.float32)
        arrays[f"{method}.vertices"] = one.vertices.astype(np.int64)
        arrays[f"{method}.positions"] = one.positions.astype(np.float32)
        arrays[f"{method}.pitch"] = np.float64(one.pitch)
    write_arrays(path, **arrays)


def read_imprints(path: str | Path) -> dict[str, Imprints]:
    """{method: Imprints} of one object, the methods in alphabetical order."""
    arrays, found = read_arrays(path), {}
    for method in sorted({key.rpartition(".")[0] for key in arrays}):
        *places, pitch = (arrays[f"{method}.{part}"] for part in PARTS)
        found[method] = Imprints(*places, pitch=np.float64(pitch))  # stays double beside f4 positions
    return found
