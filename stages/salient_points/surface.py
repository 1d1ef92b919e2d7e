"""Methods that work on the surface: a value per vertex, and its peaks as points."""

from collections.abc import Callable
from typing import Any

import numpy as np

from stages.conspicuity.surface_values import smoother
from stages.kit import Mesh
from stages.weights.standardise import standardise

from .merge import continue_on_surface
from .options import Detection, Options
from .rivals.maxima import local_maxima


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

    def saliency(self, mesh: Mesh, sight: Any, options: Options) -> np.ndarray:
        """(n,) f8 in 0..1, the largest 1."""
        return scaled(self._values(mesh))

    def find(self, mesh: Mesh, sight: Any, options: Options, count: int | None = None) -> Detection:
        """The Detection: the detector's own points are strong; count continues them by the value."""
        saliency = self.saliency(mesh, sight, options)
        own = peaks(mesh, saliency, options) if self._points is None else self._points(mesh, saliency)
        points = own if count is None else continue_on_surface(mesh, own, saliency, options.radius, count)
        return Detection(points, min(len(own), len(points)), saliency)


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
    found = local_maxima(mesh, smooth, options.radius)
    return found[standardise(smooth, mesh.vertex_areas)[found] > 1]
