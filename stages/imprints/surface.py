"""A mesh prepared for touching."""

from functools import lru_cache

import numpy as np

from stages.kit import Mesh
from stages.meshes.load import MeshLike, as_mesh

from .kernels import face_tree, first_below, measure

LIFT = 1e-6  # of the mesh's diagonal: a face within this distance of the plane is at it; 16 steps in f4


class Surface:
    """A mesh prepared for touching: its faces in a tree of boxes (20 ms for 50,000 faces).

    mesh: a Mesh, which must not change afterwards, or what `as_mesh` makes one of. Faces without area are ignored. Use
    a Surface to touch a mesh many times. Building one costs less than sending it to another process.
    """

    def __init__(self, mesh: MeshLike) -> None:
        self.mesh = mesh = as_mesh(mesh)
        solid = mesh.face_areas > 0
        self._tree = face_tree(mesh.vertices[mesh.faces[solid]], 2 * mesh.face_areas[solid])

    def measure(self, centres: np.ndarray, axes: np.ndarray, cells: tuple[int, int], pitches: np.ndarray) -> np.ndarray:
        """(k, rows, cols) signed distances of the cells of arrays, inf where missed. `distances` checks the arguments.

        centres (k, 3), axes (k, 3, 3), pitches (k,), all f8. The result for an array does not depend on the others.
        """
        return self._run(measure, centres, axes, cells, pitches)

    def first_below(
        self, centres: np.ndarray, axes: np.ndarray, cells: tuple[int, int], pitches: np.ndarray, window: float
    ) -> np.ndarray:
        """(k, rows, cols) distances of the cells to the first surface below, of either side of a face.

        inf where there is none, or where it is more than `window` units below the nearest of its array. Arguments as of
        `measure`, of which this takes a fraction of the time.
        """
        return self._run(first_below, centres, axes, cells, pitches, window)

    def _run(self, kernel, centres, axes, cells, pitches, *more):
        if not len(self._tree[0]):
            return np.full((len(centres), *cells), np.inf)
        # Writeable: for a read-only array numba would compile everything again.
        places = [np.require(values, np.float64, ["C", "W"]) for values in (centres, axes, pitches)]
        return kernel(*self._tree, self.mesh.diagonal, LIFT * self.mesh.diagonal, cells, *places, *more)


@lru_cache(maxsize=2)  # for touching one mesh, or two in turn, point by point
def _cached_surface(mesh):
    return Surface(mesh)


def as_surface(mesh: Mesh | Surface) -> Surface:
    """The Surface of a Mesh, cached; a Surface is returned as it is."""
    return mesh if isinstance(mesh, Surface) else _cached_surface(mesh)
