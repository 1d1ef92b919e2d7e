"""A mesh made ready for touching."""

from functools import lru_cache

import numpy as np

from stages.kit import Mesh

from .kernels import face_tree, measure

LIFT = 1e-6  # of the mesh's diagonal: so near the plane a face counts as at it; 16 steps of single precision


class Surface:
    """A mesh made ready for touching: its faces in a tree of boxes, built once (20 ms for 50,000 faces).

    mesh: a Mesh, not changed afterwards. Faces without area are nowhere felt. Make one where a mesh is touched time and
    again; it costs less to build than to send to another process.
    """

    def __init__(self, mesh):
        if not isinstance(mesh, Mesh):
            raise ValueError(f"touch a Mesh (stages.kit) or a Surface of one, got {type(mesh).__name__}")
        self.mesh = mesh
        solid = mesh.face_areas > 0
        self._tree = face_tree(mesh.vertices[mesh.faces[solid]], 2 * mesh.face_areas[solid])

    def measure(self, centres, axes, cells, pitches):
        """(k, rows, cols) signed distances of the cells of arrays, inf where missed; see `distances`, which checks.

        centres (k, 3), axes (k, 3, 3), pitches (k,), all f8. The result for an array does not depend on the others.
        """
        if not len(self._tree[0]):
            return np.full((len(centres), *cells), np.inf)
        # Writeable: for an array that is not, numba would compile everything anew.
        places = [np.require(values, np.float64, "CW") for values in (centres, axes, pitches)]
        return measure(*self._tree, self.mesh.diagonal, LIFT * self.mesh.diagonal, cells, *places)


@lru_cache(maxsize=2)  # whoever touches one mesh point by point, beside another
def _surface(mesh):
    return Surface(mesh)


def ready(mesh):
    """The Surface of a Mesh, as a rule made once; a Surface as it is."""
    return mesh if isinstance(mesh, Surface) else _surface(mesh)
