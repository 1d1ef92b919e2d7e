"""The detectors that are not published rivals.

Detectors of views fuse conspicuity maps and select points in each view. Detectors of the surface have a value per
vertex, whose peaks are the points; height and the distance to the middle are simple and strong ones. Farthest points
show how much of a detector's merit is its even spread (T3.2.3). Random points are the thesis's blind touch (T4.2.4).
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.sampling import points_in_faces

from ..channels import ViewMaps, facing
from ..channels.surface import nearest_corners, smoother
from ..rivals.maxima import local_maxima
from ..views import FOUR
from ..weights.attention import standardise
from ..weights.svm import POINTS, select_far_points
from .fuse import TERMS, continue_on_surface, fuse, merge_views
from .options import SELECTIONS, Detection, Options


class FusedDetector:
    """The unweighted average of channels (T eq. 3.8)."""

    required_weights: str | None = None  # name of the weights or SVMs without which the method cannot run

    def __init__(self, channels: Iterable[str]) -> None:
        self.channels = tuple(channels)
        self.parts: tuple[FusedDetector, ...] = (self,)  # whose points it has

    def fused(self, view_maps: ViewMaps, _options: Options) -> np.ndarray:
        """(p,) f8: the saliency of each pixel of all views."""
        return fuse(self.maps(view_maps))

    def maps(self, view_maps: ViewMaps) -> dict[str, np.ndarray]:
        """dict channel -> (p,): the maps that the method uses; ValueError for a missing one."""
        missing = [channel for channel in self.channels if channel not in view_maps.maps]
        if missing:
            raise ValueError(f"no map for {', '.join(missing)}: this method needs {', '.join(self.channels)}")
        return {channel: view_maps.maps[channel] for channel in self.channels}

    def saliency(self, _mesh: Mesh, view_maps: ViewMaps, options: Options) -> np.ndarray:
        """(n,) f8 in 0..1 per vertex."""
        return view_maps.vertex_saliency(self.fused(view_maps, options), options.smoothing)

    def find(self, mesh: Mesh, view_maps: ViewMaps, options: Options, count: int | None = None) -> Detection:
        """The Detection; count None gives the strong points alone."""
        fused = [part.fused(view_maps, options) for part in self.parts]
        saliency = view_maps.vertex_saliency(fused[0], options.smoothing)
        candidates = [_candidates(view_maps, values, options, count) for values in fused]
        vertices, values, above = (np.concatenate(part) for part in zip(*candidates, strict=True))
        points, strong = merge_views(mesh, vertices, values, above, options.radius)
        if count is not None:
            points = continue_on_surface(mesh, points, saliency, options.radius, count)
        return Detection(points, min(strong, len(points)), saliency)


class SummedDetector(FusedDetector):
    """The average of channels that are sums of their maps (T eq. 3.1 to 3.6 and 3.8 to the letter)."""

    def fused(self, view_maps: ViewMaps, _options: Options) -> np.ndarray:
        maps = self.maps(view_maps)
        return fuse(maps, {channel: TERMS.get(channel, 1) for channel in maps})


class WeightedDetector(FusedDetector):
    """The channels with the weights of that name (T eq. 3.9), published or learned."""

    def __init__(self, name: str, channels: Iterable[str]) -> None:
        super().__init__(channels)
        self.required_weights, self._name = name, name

    def fused(self, view_maps: ViewMaps, options: Options) -> np.ndarray:
        return fuse(self.maps(view_maps), options.learned.weights[self._name])


class SvmDetector(WeightedDetector):
    """The SVM of that name on the channels of each pixel (T3.2.3).

    It predicts for each pixel of the stored maps, where the thesis shrinks the maps to 200 x 200, predicts and enlarges
    the prediction: the same function, without the blur of two resizings.
    """

    def fused(self, view_maps: ViewMaps, options: Options) -> np.ndarray:
        models = options.learned.svms[self._name]
        rows = np.stack(list(self.maps(view_maps).values()), axis=1)
        if len(models) == 1:
            return next(iter(models.values())).predict(rows)
        values = np.zeros(len(rows))
        for view, model in models.items():
            part = view_maps.pixels_of_view(view)
            values[part] = model.predict(rows[part])
        return values

    def find(self, mesh: Mesh, view_maps: ViewMaps, options: Options, count: int | None = None) -> Detection:
        """As of any map, but of its strong points 32 stay, those far from each other (T3.2.3).

        An SVM takes far more of a map for salient than the other methods do.
        """
        detection = super().find(mesh, view_maps, options)
        far = select_far_points(mesh.vertices[detection.points], POINTS if count is None else min(POINTS, count))
        points = detection.points[np.sort(far)]
        if count is not None and detection.saliency is not None:
            points = continue_on_surface(mesh, points, detection.saliency, options.radius, count)
        return Detection(points, len(far), detection.saliency)


class MergedDetector(FusedDetector):
    """The points of several methods together, with the saliency of the first (the thesis's names in ...P, T3.1.5)."""

    def __init__(self, *parts: FusedDetector) -> None:
        super().__init__(dict.fromkeys(channel for part in parts for channel in part.channels))
        self.parts = parts

    def fused(self, view_maps: ViewMaps, options: Options) -> np.ndarray:
        return self.parts[0].fused(view_maps, options)


def _candidates(view_maps, values, options, count):
    """The points of each view of a map (p,), before they are merged: (vertices, values, strong), each (c,)."""
    select, radius = SELECTIONS[options.selection], options.radius * view_maps.pixels_per_unit
    parts = []
    for view in range(len(view_maps.viewpoints)):
        image, ids = view_maps.cropped_image(values, view)
        selected = select(image, radius, count)
        strong = np.arange(len(selected.rows)) < selected.strong
        parts.append((ids[selected.rows, selected.columns], selected.values, strong))
    return tuple(np.concatenate(part) for part in zip(*parts, strict=True))


class FarthestPoints:
    """Vertices chosen one after another, each the farthest from all before it (Gonzalez 1985)."""

    channels = ()
    required_weights = None

    def find(self, mesh: Mesh, _sight: None, _options: Options, count: int | None = None) -> Detection:
        """A Detection of vertices; the first is the one farthest from the centre, ties go by position."""
        if count is None:
            raise ValueError("farthest points have no threshold to stop at: give a count")
        vertex_ids = np.flatnonzero(mesh.vertex_normals.any(axis=1))
        positions = mesh.vertices[vertex_ids].round(9)
        order = vertex_ids[np.lexsort((*positions.T[::-1], -(positions**2).sum(axis=1)))]
        far = select_far_points(mesh.vertices[order], count)
        extras = np.setdiff1d(np.arange(len(order)), far)  # at the positions of others
        return Detection(order[np.r_[far, extras][:count]], None, None)


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
    """(k,) distinct vertices; fewer than count only where no more have a normal. Raises ValueError without area."""
    total, count = mesh.face_areas.sum(), min(count, len(mesh.used))
    if not total > 0:
        raise ValueError("the mesh has no area to draw points from")
    vertices = np.zeros(0, dtype=np.int64)
    for _ in range(ROUNDS):
        vertices = np.r_[vertices, _draw(mesh, mesh.face_areas / total, 4 * count, generator)]
        vertices = vertices[np.sort(np.unique(vertices, return_index=True)[1])]
        if len(vertices) >= count:
            return vertices[:count]
    extras = np.setdiff1d(np.flatnonzero(mesh.vertex_normals.any(axis=1)), vertices)  # of faces too small to be drawn
    return np.r_[vertices, generator.permutation(extras)][:count]


def _draw(mesh, probabilities, size, generator):
    faces = generator.choice(len(probabilities), size=size, p=probabilities)
    positions, _ = points_in_faces(mesh, faces, generator.random((2, size)))
    return nearest_corners(mesh, faces, positions)


class SurfaceDetector:
    """A detector that computes a value per vertex from the mesh alone, and selects points by it."""

    channels: tuple[str, ...] = ()
    required_weights: str | None = None

    def __init__(
        self,
        values: Callable[[Mesh], np.ndarray],
        points: Callable[[Mesh, np.ndarray], np.ndarray] | None = None,
    ) -> None:
        """values: mesh -> (n,) f8, at least zero; points: (mesh, values) -> (k,) most salient first, None for peaks."""
        self._values, self._points = values, points

    def saliency(self, mesh: Mesh, view_maps: Any, options: Options) -> np.ndarray:
        """(n,) f8 in 0..1, the largest 1."""
        return scaled(self._values(mesh))

    def find(self, mesh: Mesh, view_maps: Any, options: Options, count: int | None = None) -> Detection:
        """The Detection: the detector's own points are strong; count continues them by the value."""
        saliency = self.saliency(mesh, view_maps, options)
        strong = peaks(mesh, saliency, options) if self._points is None else self._points(mesh, saliency)
        points = strong if count is None else continue_on_surface(mesh, strong, saliency, options.radius, count)
        return Detection(points, min(len(strong), len(points)), saliency)


def scaled(values: np.ndarray) -> np.ndarray:
    """Values (n,) of at least zero over their maximum, rounded to six digits so that rounding errors decide nothing."""
    top = values.max(initial=0)
    return (values / top).round(6) if top > 0 else np.zeros(len(values))


def peaks(mesh: Mesh, saliency: np.ndarray, options: Options) -> np.ndarray:
    """(k,) vertices, most salient first, where the smoothed saliency has a high maximum within the radius.

    Smoothed over options.smoothing, since noise has peaks too. High is more than one standard deviation above the mean
    over the area: on human gaze about as many points as the thesis's threshold gives (T3.2.5), with fewer misses.
    """
    if not saliency.any():
        return np.zeros(0, dtype=np.int64)
    smooth = smoother(mesh, np.ones(len(saliency)), options.smoothing)(saliency).clip(0)
    maxima = local_maxima(mesh, smooth, options.radius)
    return maxima[standardise(smooth, mesh.vertex_areas)[maxima] > 1]


def height(mesh: Mesh) -> np.ndarray:
    """(n,) height of each vertex: people look at the upper part of things.

    Examples
    --------
    >>> height(Mesh([[0, 0, 0], [1, 0, 0], [0, 0, 2]], [[0, 1, 2]]))
    array([0., 0., 2.])
    """
    return _in_faces(mesh, mesh.vertices[:, 2] - mesh.vertices[mesh.used, 2].min(initial=np.inf))


def centre_distance(mesh: Mesh) -> np.ndarray:
    """(n,) distance of each vertex to the centre of the bounding sphere.

    Examples
    --------
    >>> centre_distance(Mesh([[0, 0, 0], [1, 0, 0], [0, 0, 2]], [[0, 1, 2]]))
    array([0., 1., 2.])
    """
    return _in_faces(mesh, np.linalg.norm(mesh.vertices, axis=1))


def _in_faces(mesh, values):
    """The values (n,), 0 for a vertex in no face, which may lie anywhere."""
    face_values = np.zeros(len(values))
    face_values[mesh.used] = values[mesh.used]
    return face_values


def facing_viewer(mesh: Mesh) -> np.ndarray:
    """(n,) cosine between the normal and the view direction, averaged over the four views from the side.

    Examples
    --------
    >>> facing_viewer(Mesh([[0, 0, 0], [1, 0, 0], [0, 0, 2]], [[0, 1, 2]]))
    array([0.5, 0.5, 0.5])
    """
    return facing(mesh, FOUR).mean(axis=0)


# The methods that are one function of the mesh; those in look/rivals have a line in PUBLISHED of methods.py.
SURFACE: dict[str, Callable[[Mesh], np.ndarray]] = {
    "height": height,
    "centre_distance": centre_distance,
    "facing_viewer": facing_viewer,
}
