"""The conspicuity maps of all views of an object, with the correspondence of pixels and vertices."""

from collections.abc import Iterable, Mapping

import numpy as np
from scipy import sparse

from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene

from .. import camera
from ..camera import Viewpoint
from .cropped_view import facing
from .surface import SMOOTHING, nearest_corners, smoother

MIN_WEIGHT = 1e-9  # sum of bilinear weights; below it a vertex has no pixel of the object around it


class ViewMaps:
    """A mesh with the conspicuity maps of its views.

    mesh: normalised; viewpoints: v Viewpoints; maps: dict channel -> (v, h, w), zero off the object; mask (v, h, w)
    boolean or None: the pixels that count. Pixels whose ray misses the object never count, so that the border of a
    reduced map cannot select a point off the object.

    The p pixels of all views that count are stored in one list. maps: dict channel -> (p,) f8; vertices (p,) i8: the
    vertex that each pixel shows; facing (v, n) f8: haptic_glance.look.channels.cropped_view of the viewpoints.

    Raises ValueError for maps of the wrong shape, with negative or NaN values, or when no pixel sees the mesh.
    """

    def __init__(
        self,
        mesh: Mesh,
        viewpoints: Iterable[Viewpoint],
        maps: Mapping[str, np.ndarray],
        mask: np.ndarray | None = None,
    ) -> None:
        self.mesh, self.viewpoints = mesh, list(viewpoints)
        shape = _check_maps(maps, len(self.viewpoints))
        self.size = shape[1:]
        self.pixels_per_unit = camera.pixels_per_unit(shape[1])
        self._scene = RayScene(mesh)
        self._seen = np.zeros(shape, dtype=bool)  # filled view by view
        self.vertices = np.concatenate([self._cast_rays(view, mask) for view in range(len(self.viewpoints))])
        if len(self.vertices) == 0:
            raise ValueError(
                "no pixel of any view sees the mesh: normalise it (haptic_glance.mesh.repair), and if it is flat "
                "choose views from above and below, too (views.viewpoints=twelve)"
            )
        self._ends = np.cumsum(self._seen.sum(axis=(1, 2)))
        self.maps = {channel: np.asarray(values)[self._seen].astype(np.float64) for channel, values in maps.items()}
        self.facing = facing(mesh, self.viewpoints, self._scene)
        self._to_vertices, self._facing_sums = self._vertex_sampler()
        self._smoothers = {}  # smoothing length -> function, whose equations are factored for all methods together

    def _cast_rays(self, view, mask):
        """Marks the pixels of one view that see the mesh, and returns the vertex that each of them shows."""
        pixels = np.ones(self.size, dtype=bool) if mask is None else np.asarray(mask[view], dtype=bool)
        rows, columns = np.nonzero(pixels & self._silhouette_box(view))
        origins, directions = camera.pixel_rays(rows, columns, self.viewpoints[view], self.size)
        hits = self._scene.cast(origins, directions)
        hit = np.flatnonzero(hits.hit)
        self._seen[view, rows[hit], columns[hit]] = True
        positions = origins[hit] + hits.distance[hit, None] * directions[hit]
        return nearest_corners(self.mesh, hits.face[hit], positions)

    def _silhouette_box(self, view):
        """(h, w) boolean: the pixels within the bounding box of the projected mesh; no other ray can hit it."""
        rows, columns, _ = camera.project(self.mesh.vertices, self.viewpoints[view], self.size)
        r, c = np.ogrid[: self.size[0], : self.size[1]]
        return (r >= rows.min()) & (r <= rows.max()) & (c >= columns.min()) & (c <= columns.max())

    def cropped_image(self, values: np.ndarray, view: int) -> tuple[np.ndarray, np.ndarray]:
        """The values (p,) in one view as an image, cropped to the object: ((h', w') f8, vertex ids (h', w') i8)."""
        visible = self._seen[view]
        if not visible.any():
            return np.zeros((1, 1)), np.zeros((1, 1), dtype=np.int64)
        rows, columns = np.flatnonzero(visible.any(axis=1)), np.flatnonzero(visible.any(axis=0))
        box = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        part = self.pixels_of_view(view)
        image, ids = np.zeros(self.size), np.zeros(self.size, dtype=np.int64)
        image[visible], ids[visible] = values[part], self.vertices[part]
        return image[box], ids[box]

    def pixels_of_view(self, view: int) -> slice:
        """The slice of the list of pixels that belongs to a view."""
        return slice(self._ends[view] - self._seen[view].sum(), self._ends[view])

    def vertex_saliency(self, values: np.ndarray, smoothing: float = SMOOTHING) -> np.ndarray:
        """Pixel values (p,) averaged on the vertices, over their maximum: (n,) f8 in 0..1; zeros if all are zero."""
        smooth = self.vertex_values(values, smoothing)
        top = smooth.max()
        # Rounded, so that the last bits of the solver cannot change the order of vertices between machines.
        return np.clip(smooth / top, 0, 1).round(6) if top > 0 else np.zeros(len(smooth))

    def vertex_values(self, values: np.ndarray, smoothing: float = SMOOTHING) -> np.ndarray:
        """Pixel values (p,) averaged on the vertices and smoothed over the surface: (n,) f8 in the unit of the values.

        The average is over the views that see a vertex, weighted by the cosine between its normal and the line of
        sight: at a grazing angle, one pixel covers much surface and says little about each point of it.
        """
        if smoothing not in self._smoothers:
            confidence = np.minimum(self._facing_sums, 1)  # one frontal view of a vertex suffices
            self._smoothers[smoothing] = smoother(self.mesh, confidence, smoothing)
        average = np.divide(
            self._to_vertices @ values,
            self._facing_sums,
            out=np.zeros(len(self._facing_sums)),
            where=self._facing_sums > 0,
        )
        return self._smoothers[smoothing](average)

    def _vertex_sampler(self):
        """(sparse (n, p): pixels to vertices, weighted by facing; (n,) the sums of the weights)."""
        index = np.full(self._seen.shape, -1)
        index[self._seen] = np.arange(len(self.vertices))
        parts = [self._pixel_weights(view, index[view]) for view in range(len(self.viewpoints))]
        vertices, pixels, weights = (np.concatenate(part) for part in zip(*parts, strict=True))
        shape = (len(self.mesh.vertices), len(self.vertices))
        matrix = sparse.csr_matrix((weights, (vertices, pixels)), shape=shape)
        return matrix, np.asarray(matrix.sum(axis=1)).ravel()

    def _pixel_weights(self, view, index):
        """Bilinear weights of the pixels around each visible vertex of one view: (vertices, pixels, weights)."""
        ids = np.flatnonzero(self.facing[view])
        rows, columns, _ = camera.project(self.mesh.vertices[ids], self.viewpoints[view], self.size)
        corners = np.array([[0, 0], [0, 1], [1, 0], [1, 1]])
        r = np.floor(rows)[:, None].astype(np.int64) + corners[:, 0]
        c = np.floor(columns)[:, None].astype(np.int64) + corners[:, 1]
        inside = (r >= 0) & (r < self.size[0]) & (c >= 0) & (c < self.size[1])
        pixel = np.where(inside, index[np.where(inside, r, 0), np.where(inside, c, 0)], -1)
        weight = (1 - np.abs(rows[:, None] - r)) * (1 - np.abs(columns[:, None] - c)) * (pixel >= 0)
        total = weight.sum(axis=1, keepdims=True)  # less than 1 at the silhouette, where pixels off the object drop out
        weight = self.facing[view, ids, None] * np.divide(
            weight, total, out=np.zeros_like(weight), where=total > MIN_WEIGHT
        )
        is_positive = weight > 0
        return np.broadcast_to(ids[:, None], is_positive.shape)[is_positive], pixel[is_positive], weight[is_positive]


def _check_maps(maps, views):
    """The maps' common shape (views, h, w)."""
    if not maps:
        raise ValueError("no conspicuity maps: give at least one channel")
    for channel, values in maps.items():
        values = np.asarray(values)
        if values.ndim != 3 or len(values) != views or values.size == 0:
            raise ValueError(f"map {channel!r} must have shape ({views} views, h, w), got {values.shape}")
        if not np.isfinite(values).all() or values.min() < 0:
            raise ValueError(f"map {channel!r} must be finite and not negative")
    shapes = {np.shape(values) for values in maps.values()}
    if len(shapes) > 1:
        raise ValueError(f"conspicuity maps must have one shape, got {sorted(shapes)}")
    return shapes.pop()
