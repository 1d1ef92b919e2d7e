"""A surface made ready to be measured: samples of it, and its nearest point to any other, exact.

point_cloud_utils and trimesh build a tree at every call, which takes longer than the 10,000 questions that follow, and
pymeshlab a grid; `benchmarks.errors` holds this against the latter. Here a surface is made ready once, and most
questions come from places close to it: the faces of one cell are bounded without a branch, one of them is measured, and
seldom another cell is left to look at. (point_cloud_utils 0.34 also misreads an array of a single point.)
"""

from functools import cached_property, lru_cache

import numpy as np

from .kernels.cells import bounding_box, cell_boxes, fill_cells, planes_of
from .kernels.face_frame import corner_weights
from .kernels.grid import farthest, sample, search

CELLS_PER_FACE = 4  # a cell is then a little wider than an edge is long; more cells cost more memory than they save
MOST = 64  # cells that a face may lie in on average: long slanted faces lie in so many that memory runs out
THIN = 1e-3  # of the longest side: boxes flatter than this are cut as if they were this thick
FAR = 4.0  # cells: farther off, the search goes on in a grid of wider cells
WIDER = 4  # times
LARGEST = 1e100  # coordinate, and one over it the smallest extent: beyond, squares overflow
ROOM = 1e-9  # of the longest side: so far the grid reaches over the box, so that rounding pushes nothing out


class Surface:
    """The faces of a mesh as planes (m, 16) in a grid, and the diagonal of the box around them.

    Raises ValueError for a mesh without faces.
    """

    def __init__(self, mesh):
        if len(mesh.faces) == 0:
            raise ValueError("a mesh without faces has no surface to measure")
        self.mesh = mesh
        low, high = bounding_box(mesh.vertices, mesh.faces)
        self.extent = high - low
        self.diagonal = float(np.linalg.norm(self.extent))
        if self.diagonal > LARGEST or 0 < self.extent.max() < 1 / LARGEST:
            raise ValueError(f"a mesh of diagonal {self.diagonal:.3g} is out of range: scale it, see stages.meshes")
        self.low = low - ROOM * self.extent.max()
        self.planes, self.areas = planes_of(mesh.vertices, mesh.faces, self.low)
        self.grid = self._filled(CELLS_PER_FACE)

    @cached_property
    def coarse(self):
        """The grid for questions from far off, whose cells are WIDER times as wide."""
        return self._filled(CELLS_PER_FACE / WIDER**3)

    def _filled(self, cells_per_face):
        """(starts, entries, lower corner, width of a cell, cells along each axis): see fill_cells."""
        thick = np.maximum(self.extent, THIN * (self.extent.max() or 1.0))
        cell = (thick ** (1 / 3)).prod() / (cells_per_face * len(self.planes)) ** (1 / 3)
        while True:
            shape = np.ceil((self.extent + 2 * ROOM * self.extent.max()) / cell).astype(np.int64).clip(1)
            boxes, total = cell_boxes(self.mesh.vertices, self.mesh.faces, self.low, cell, shape)
            if total <= MOST * len(boxes):
                return *fill_cells(boxes, total, shape), self.low, cell, shape
            cell *= 2

    def _known(self, grid):
        return self.mesh.vertices, self.mesh.faces, grid, self.planes

    def sample(self, count, generator):
        """(points (count, 3), faces (count,), corner weights (count, 3)) spread evenly by area.

        One in each of `count` equal slices of the area, in the order of the faces: each face gets its share to within
        one point. Raises ValueError for a mesh without area.
        """
        total = np.cumsum(self.areas)
        if not total[-1] > 0:
            raise ValueError("cannot sample a mesh without area")
        draws = generator.random((3, count))
        return sample(self.mesh.vertices, self.mesh.faces, total, draws)

    def nearest(self, points):
        """(distances (k,), faces (k,)) of the surface's nearest points to points (k, 3)."""
        points = np.ascontiguousarray(points, dtype=np.float64)
        if not (np.abs(points) < LARGEST).all():
            raise ValueError("points to measure hold NaN, infinite or huge coordinates")
        squares, faces = search(points, *self._known(self.grid), FAR)
        far = np.flatnonzero(faces < 0)
        if len(far):
            squares[far], faces[far] = search(points[far], *self._known(self.coarse), np.inf)
        return np.sqrt(squares), faces

    def farthest(self, other, least):
        """The largest distance of a vertex of the Surface `other` (in a face) to this one, or `least` if that is more.

        Vertices nearer than the largest so far are not measured to the end.
        """
        square, far = farthest(other.mesh.vertices, other.mesh.faces, *self._known(self.grid), least**2, FAR)
        return max(np.sqrt(square), self.nearest(other.mesh.vertices[far])[0].max(initial=0))

    def weights(self, points, faces):
        """(k, 3) weights of the corners of faces (k,) at their places nearest to points (k, 3)."""
        return corner_weights(points, faces, self.mesh.vertices, self.mesh.faces)


@lru_cache(maxsize=2)  # a reference and, one after the other, the meshes measured against it
def surface(mesh):
    """The Surface of a mesh, made once."""
    return Surface(mesh)
