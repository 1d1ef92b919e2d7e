"""The methods `glance`, `glance_any_pose` and `glance_deep`: the fixation density of small cells of the surface."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from stages.glance import Samples, samples_of_mesh, standardised
from stages.kit import Mesh
from stages.weights import fixation_density
from stages.weights.standardise import standardise

from .deep import standardised_maps
from .inhibition import by_place, tied, visited
from .merge import continue_on_surface
from .options import Detection, Options
from .rivals.maxima import local_maxima
from .surface import scaled

NO_FACES = np.zeros((0, 3), dtype=np.int64)
Features = Callable[[Mesh, Samples], dict[str, np.ndarray]]


def cell_features(mesh: Mesh, samples: Samples) -> dict[str, np.ndarray]:
    """dict name -> (s,) f8: the features of stages.glance."""
    return standardised(samples)


def deep_features(mesh: Mesh, samples: Samples) -> dict[str, np.ndarray]:
    """dict name -> (s,) f8: the features of stages.glance and the maps of a network; needs the extra `deep`."""
    return standardised_maps(mesh, samples) | standardised(samples)


class SampledDetector(ABC):
    """A detector that looks at cells of the surface, so that neither the faces nor noise decide what it finds."""

    channels: tuple[str, ...] = ()
    required_weights: str | None = None

    @abstractmethod
    def _values(self, mesh: Mesh, options: Options) -> tuple[Samples, np.ndarray, np.ndarray]:
        """(samples, their values (s,), above 0, and the smooth values (s,) whose peaks are the points)."""

    def _vertices(self, mesh: Mesh, samples: Samples, chosen: np.ndarray) -> np.ndarray:
        """(k,) the vertices that stand for samples (k,)."""
        return mesh.used[KDTree(mesh.vertices[mesh.used]).query(samples.points[chosen])[1]]

    def saliency(self, mesh: Mesh, sight: Any, options: Options) -> np.ndarray:
        """(n,) f8 in 0..1, the largest 1; zeros for a mesh without area."""
        if not mesh.face_areas.sum() > 0:
            return np.zeros(len(mesh.vertices))
        samples, values, _ = self._values(mesh, options)
        return _on_vertices(mesh, samples, values)[0]

    def find(self, mesh: Mesh, sight: Any, options: Options, count: int | None = None) -> Detection:
        """The Detection: strong points are high peaks of the smooth values; a count visits more places."""
        none = np.zeros(0, dtype=np.int64)
        if not mesh.face_areas.sum() > 0:
            return Detection(none, 0, np.zeros(len(mesh.vertices)))
        samples, values, smooth = self._values(mesh, options)
        peaks = local_maxima(Mesh(samples.points, NO_FACES), smooth, options.radius)
        peaks = peaks[standardise(smooth, samples.areas)[peaks] > 1]
        peaks = peaks[by_place(tied(smooth[peaks]), samples.points[peaks])]
        order = peaks if count is None else visited(samples.points, smooth, options.radius, count)
        is_peak = np.isin(order, peaks)
        chosen = np.r_[order[is_peak], order[~is_peak]]
        at = self._vertices(mesh, samples, chosen) if len(chosen) else none
        points = at[np.sort(np.unique(at, return_index=True)[1])]
        saliency, smoothed = _on_vertices(mesh, samples, values, smooth)
        if count is not None:
            points = continue_on_surface(mesh, points, smoothed, options.radius, count)
        return Detection(points, min(int(is_peak.sum()), len(points)), saliency)


class GlanceDetector(SampledDetector):
    """The fixation density of a log-linear model that human gaze has taught."""

    def __init__(self, weights: str, features: Features = cell_features) -> None:
        self.required_weights = self._weights = weights  # a key of stages.weights.published.GLANCES, or DEEP
        self._features = features

    def _values(self, mesh: Mesh, options: Options) -> tuple[Samples, np.ndarray, np.ndarray]:
        samples = samples_of_mesh(mesh)
        density = fixation_density(self._features(mesh, samples), options.learned.weights[self._weights])
        # noise moves this less than a mean
        return samples, density, np.exp(samples.smoothed(np.log(density), options.smoothing))


def _on_vertices(mesh, samples, *values):
    """(n,) f8 in 0..1 of each of the values (s,) of the samples: at the vertices, 0 where these have no area."""
    near, weights = samples.interpolation(mesh.vertices, mesh.vertex_normals)
    has_area = mesh.vertex_areas > 0
    return [scaled(np.where(has_area, (one[near] * weights).sum(axis=1), 0)) for one in values]
