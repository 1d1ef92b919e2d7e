"""The files of the stage: data/imprints/NAME.npz."""

from dataclasses import dataclass

import numpy as np

from stages.kit.files import read_arrays, write_arrays

PARTS = ("images", "vertices", "positions", "pitch")


@dataclass(frozen=True)
class Imprints:
    """The touches of one object at the points of one method, in the order of the points.

    images (k, rows, cols) f4 in 0..1, vertices (k,) i8 ids in the mesh, positions (k, 3) f4 in units of the mesh,
    pitch: units between neighbouring cells.
    """

    images: np.ndarray
    vertices: np.ndarray
    positions: np.ndarray
    pitch: float

    @property
    def width(self):
        """The longer side of the array, in units of the mesh."""
        return max(self.images.shape[1:]) * self.pitch


def write_imprints(path, imprints):
    """Writes {method: Imprints} as the arrays METHOD.images, .vertices, .positions and .pitch."""
    arrays = {}
    for method in sorted(imprints):
        one = imprints[method]
        arrays[f"{method}.images"] = one.images.astype(np.float32)
        arrays[f"{method}.vertices"] = one.vertices.astype(np.int64)
        arrays[f"{method}.positions"] = one.positions.astype(np.float32)
        arrays[f"{method}.pitch"] = np.float64(one.pitch)
    write_arrays(path, **arrays)


def read_imprints(path):
    """{method: Imprints} of one object, the methods in alphabetical order."""
    arrays = read_arrays(path)
    methods = sorted({key.rpartition(".")[0] for key in arrays})
    return {method: Imprints(*(arrays[f"{method}.{part}"] for part in PARTS)) for method in methods}
