"""Methods that fuse conspicuity maps and select points in each view."""

from collections.abc import Iterable

import numpy as np

from stages.conspicuity import ViewMaps
from stages.kit import Mesh
from stages.weights.svm_pixels import POINTS, select_far_points

from .fuse import fuse
from .merge import continue_on_surface, merge_views
from .options import SELECTIONS, Detection, Options


class FusedDetector:
    """The unweighted average of channels (T eq. 3.8)."""

    required_weights: str | None = None  # name of the weights or SVMs without which the method cannot run

    def __init__(self, channels: Iterable[str]) -> None:
        self.channels = tuple(channels)
        self.parts: tuple[FusedDetector, ...] = (self,)  # whose points it has

    def fused(self, sight: ViewMaps, _options: Options) -> np.ndarray:
        """(p,) f8: the saliency of each pixel of all views."""
        return fuse(self.maps(sight))

    def maps(self, sight: ViewMaps) -> dict[str, np.ndarray]:
        """dict channel -> (p,): the maps that the method uses; ValueError for a missing one."""
        missing = [channel for channel in self.channels if channel not in sight.maps]
        if missing:
            raise ValueError(f"no map for {', '.join(missing)}: this method needs {', '.join(self.channels)}")
        return {channel: sight.maps[channel] for channel in self.channels}

    def saliency(self, _mesh: Mesh, sight: ViewMaps, options: Options) -> np.ndarray:
        """(n,) f8 in 0..1 per vertex."""
        return sight.vertex_saliency(self.fused(sight, options), options.smoothing)

    def find(self, mesh: Mesh, sight: ViewMaps, options: Options, count: int | None = None) -> Detection:
        """The Detection; count None gives the strong points alone."""
        fused = [part.fused(sight, options) for part in self.parts]
        saliency = sight.vertex_saliency(fused[0], options.smoothing)
        candidates = [_candidates(sight, values, options, count) for values in fused]
        vertices, values, above = (np.concatenate(part) for part in zip(*candidates, strict=True))
        points, strong = merge_views(mesh, vertices, values, above, options.radius)
        if count is not None:
            points = continue_on_surface(mesh, points, saliency, options.radius, count)
        return Detection(points, min(strong, len(points)), saliency)


class WeightedDetector(FusedDetector):
    """All nine channels with the weights of that name (T eq. 3.9), published or learned."""

    def __init__(self, name: str, channels: Iterable[str]) -> None:
        super().__init__(channels)
        self.required_weights, self._name = name, name

    def fused(self, sight: ViewMaps, options: Options) -> np.ndarray:
        return fuse(self.maps(sight), options.learned.weights[self._name])


class SvmDetector(FusedDetector):
    """The SVM of that name on the channels of each pixel (T3.2.3).

    It predicts for each pixel of the stored maps, where the thesis shrinks the maps to 200 x 200, predicts and enlarges
    the prediction: the same function, without the blur of two resizings.
    """

    def __init__(self, name: str, channels: Iterable[str]) -> None:
        super().__init__(channels)
        self.required_weights, self._name = name, name

    def fused(self, sight: ViewMaps, options: Options) -> np.ndarray:
        models = options.learned.svms[self._name]
        rows = np.stack(list(self.maps(sight).values()), axis=1)
        if len(models) == 1:
            return next(iter(models.values())).predict(rows)
        values = np.zeros(len(rows))
        for view, model in models.items():
            part = sight.pixels_of_view(view)
            values[part] = model.predict(rows[part])
        return values

    def find(self, mesh: Mesh, sight: ViewMaps, options: Options, count: int | None = None) -> Detection:
        """As of any map, but of its strong points 32 stay, those far from each other (T3.2.3).

        An SVM takes far more of a map for salient than the other methods do.
        """
        found = super().find(mesh, sight, options)
        far = select_far_points(mesh.vertices[found.points], POINTS if count is None else min(POINTS, count))
        points = found.points[np.sort(far)]
        if count is not None and found.saliency is not None:
            points = continue_on_surface(mesh, points, found.saliency, options.radius, count)
        return Detection(points, len(far), found.saliency)


class MergedDetector(FusedDetector):
    """The points of several methods together, with the saliency of the first (the thesis's names in ...P, T3.1.5)."""

    def __init__(self, *parts: FusedDetector) -> None:
        super().__init__(dict.fromkeys(channel for part in parts for channel in part.channels))
        self.parts = parts

    def fused(self, sight: ViewMaps, options: Options) -> np.ndarray:
        return self.parts[0].fused(sight, options)


def _candidates(sight, values, options, count):
    """The points of each view of a map (p,), before they are merged: (vertices, values, strong), each (c,)."""
    select, radius = SELECTIONS[options.selection], options.radius * sight.pixels_per_unit
    parts = []
    for view in range(len(sight.viewpoints)):
        image, ids = sight.cropped_image(values, view)
        selected = select(image, radius, count)
        strong = np.arange(len(selected.rows)) < selected.strong
        parts.append((ids[selected.rows, selected.columns], selected.values, strong))
    return tuple(np.concatenate(part) for part in zip(*parts, strict=True))
