"""A surface indexed for distances: samples of it, and the exact nearest point on it to any other point.

point_cloud_utils and trimesh build a tree at every call, which takes longer than the 10,000 queries that follow, and
pymeshlab builds a grid; `benchmarks.kernels` compares with the latter. Here a surface is indexed once, and most queries
are close to it: the faces of one cell are bounded without a branch, one of them is measured, and seldom must another
cell be searched. (point_cloud_utils 0.34 also misreads an array of a single point.)
"""

from functools import cached_property, lru_cache

import numpy as np

from .kernels.nearest import Grid, cell_boxes, farthest, fill_cells, planes_of, search
from .kernels.planes import corner_weights
from .mesh import Mesh, bounding_box
from .sampling import sample_surface

CELLS_PER_FACE = 4  # a cell is then a little wider than an edge is long; more cells cost more memory than they save
MAX_CELLS = 64  # per face on average: long slanted faces lie in so many cells that memory would run out
THIN = 1e-3  # of the longest side: flatter boxes are divided as if they were this thick
FAR = 4.0  # cells: beyond, the search goes on in a grid of wider cells
WIDER = 4  # times as wide as those of the fine grid
MAX_COORDINATE = 1e100  # and one over it the smallest extent: beyond, squares overflow
MARGIN = 1e-9  # of the longest side, around the box, so that rounding leaves nothing outside the grid


class SurfaceIndex:
    """The faces of a mesh as planes (m, 16) in a grid, and the diagonal of their bounding box.

    Raises ValueError for a mesh without faces.
    """

    def __init__(self, mesh: Mesh) -> None:
        if len(mesh.faces) == 0:
            raise ValueError("a mesh without faces has no surface to measure")
        self.mesh = mesh = Mesh(mesh.vertices, mesh.faces)  # its own: the caller may edit the arrays of the other
        low, high = bounding_box(mesh)
        self.extent = high - low
        self.diagonal = float(np.linalg.norm(self.extent))
        if self.diagonal > MAX_COORDINATE or 0 < self.extent.max() < 1 / MAX_COORDINATE:
            raise ValueError(
                f"a mesh of diagonal {self.diagonal:.3g} is out of range: scale it, see haptic_glance.mesh.normalise"
            )
        self.low = low - MARGIN * self.extent.max()
        self.planes, self.areas = planes_of(mesh.vertices, mesh.faces, self.low)
        self.grid = self._build_grid(CELLS_PER_FACE)

    @cached_property
    def coarse(self) -> Grid:
        """The grid for distant points, with wider cells."""
        return self._build_grid(CELLS_PER_FACE / WIDER**3)

    def _build_grid(self, cells_per_face) -> Grid:
        thick = np.maximum(self.extent, THIN * (self.extent.max() or 1.0))
        cell = (thick ** (1 / 3)).prod() / (cells_per_face * len(self.planes)) ** (1 / 3)
        while True:
            shape = np.ceil((self.extent + 2 * MARGIN * self.extent.max()) / cell).astype(np.int64).clip(1)
            boxes, total = cell_boxes(self.mesh.vertices, self.mesh.faces, self.low, cell, shape)
            if total <= MAX_CELLS * len(boxes):
                return *fill_cells(boxes, total, shape), self.low, cell, shape
            cell *= 2

    def _search_arguments(self, grid):
        return self.mesh.vertices, self.mesh.faces, grid, self.planes

    def sample(self, count: int, generator: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(points (count, 3), faces (count,), barycentric weights (count, 3)), one in each of `count` slices by area.

        Raises ValueError for a mesh without area.
        """
        draws = generator.random((3, count))
        return sample_surface(self.mesh, (np.arange(count) + draws[0]) / count, draws[1:], self.areas)

    def nearest(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(distances (k,), faces (k,)) of the surface's nearest points to points (k, 3)."""
        points = np.ascontiguousarray(points, dtype=np.float64)
        if not (np.abs(points) < MAX_COORDINATE).all():
            raise ValueError("points to measure have NaN, infinite or huge coordinates")
        squares, faces = search(points, *self._search_arguments(self.grid), FAR)
        far = np.flatnonzero(faces < 0)
        if len(far):
            squares[far], faces[far] = search(points[far], *self._search_arguments(self.coarse), np.inf)
        return np.sqrt(squares), faces

    def farthest(self, other: "SurfaceIndex", least: float) -> float:
        """The largest distance of a vertex of `other` (in a face) to this surface, or `least` if that is larger.

        The search for a vertex stops as soon as it is nearer than the largest distance so far.
        """
        square, far = farthest(other.mesh.vertices, other.mesh.faces, *self._search_arguments(self.grid), least**2, FAR)
        return max(np.sqrt(square), self.nearest(other.mesh.vertices[far])[0].max(initial=0))

    def weights(self, points: np.ndarray, faces: np.ndarray) -> np.ndarray:
        """(k, 3) barycentric weights, in faces (k,), of their points nearest to points (k, 3)."""
        return corner_weights(points, faces, self.mesh.vertices, self.mesh.faces)


_cached_index = lru_cache(maxsize=2)(SurfaceIndex)  # a reference and the mesh measured against it


def surface_index(mesh: Mesh) -> SurfaceIndex:
    """The SurfaceIndex of a mesh, cached; made anew where the vertices of the mesh were edited in place."""
    index = _cached_index(mesh)
    if not np.array_equal(index.mesh.vertices, mesh.vertices):
        _cached_index.cache_clear()
        index = _cached_index(mesh)
    return index


def closest(mesh: Mesh, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(distances (k,), faces (k,), barycentric weights (k, 3)): the closest points on a mesh to points (k, 3)."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    index = surface_index(mesh)
    distances, faces = index.nearest(points)
    return distances, faces, index.weights(points, faces)


def same_place(vertices: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(k,) i8: the last one of vertices (n, 3) that has exactly the place of each of points (k, 3), -1 for none."""
    place = np.unique(np.concatenate([vertices, points]), axis=0, return_inverse=True)[1].ravel()
    owner = np.full(len(place), -1)
    owner[place[: len(vertices)]] = np.arange(len(vertices))
    return owner[place[len(vertices) :]]
