"""Methods that work on the surface: a value at each vertex, and its peaks as points."""

import numpy as np

from stages.conspicuity.surface_values import smoother
from stages.weights import fixation_density, vertex_features
from stages.weights.features import standardise

from .merge import continue_on_surface
from .options import Found
from .rivals.maxima import local_maxima


class OnSurface:
    """A detector that gives each vertex a value, and its own choice of points."""

    channels = ()  # it looks at no conspicuity map
    learned = None

    def __init__(self, values, points=None):
        """values: mesh -> (n,) f8, at least zero; points: (mesh, values) -> (k,) most salient first, None for peaks."""
        self._values, self._points = values, points

    def saliency(self, mesh, _sight, _options):
        """(n,) f8 in 0..1, the largest 1."""
        return scaled(self._values(mesh))

    def find(self, mesh, sight, options, count=None):
        """Found points: the detector's own are strong; count continues them by the value."""
        saliency = self.saliency(mesh, sight, options)
        own = peaks(mesh, saliency, options) if self._points is None else self._points(mesh, saliency)
        points = own if count is None else continue_on_surface(mesh, own, saliency, options.radius, count)
        return Found(points, min(len(own), len(points)), saliency)


class Fixations(OnSurface):
    """The density of looks that the fixation model predicts (stages.weights.fixations)."""

    def __init__(self, name, channels):
        super().__init__(None)
        self.learned, self.channels = name, tuple(channels)

    def saliency(self, mesh, sight, options):
        channels = {name: sight.averaged(sight.maps[name], options.smoothing) for name in self.channels}
        weights = options.learned.weights[self.learned]
        features = vertex_features(mesh, sight.viewpoints, sight.facing, channels)
        return scaled(np.where(mesh.vertex_areas > 0, fixation_density(features, weights), 0))


def scaled(values):
    """Values (n,) of at least zero over the largest, rounded so that last bits decide nothing; zeros stay zeros."""
    top = values.max(initial=0)
    return (values / top).round(6) if top > 0 else np.zeros(len(values))


def peaks(mesh, saliency, options):
    """(k,) vertices, most salient first, where the smoothed saliency is highest within the radius and stands out.

    Smoothed over options.smoothing, since noise has peaks too. To stand out is to lie more than one deviation above the
    mean over the area: on human gaze about as many points as the thesis's threshold gives (T3.2.5), at fewer misses.
    """
    if not saliency.any():
        return np.zeros(0, dtype=np.int64)
    smooth = smoother(mesh, np.ones(len(saliency)), options.smoothing)(saliency).clip(0)
    found = local_maxima(mesh, smooth, options.radius)
    return found[standardise(smooth, mesh.vertex_areas)[found] > 1]
