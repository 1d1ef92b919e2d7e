"""Methods that fuse conspicuity maps, and pick points in each view."""

import numpy as np

from .fuse import fuse
from .merge import continue_on_surface, merge_views
from .options import SELECTIONS, Found


class Fused:
    """An average of channels (T eq. 3.8)."""

    learned = None  # the weights or SVMs that the method cannot do without

    def __init__(self, channels):
        self.channels = tuple(channels)

    def fused(self, sight, _options):
        """(p,) f8: the saliency map of all views, pixel by pixel."""
        return fuse(self.maps(sight))

    def maps(self, sight):
        """dict channel -> (p,): the maps that the method looks at; ValueError for one that is not there."""
        missing = [channel for channel in self.channels if channel not in sight.maps]
        if missing:
            raise ValueError(f"no map for {', '.join(missing)}: this method needs {', '.join(self.channels)}")
        return {channel: sight.maps[channel] for channel in self.channels}

    def saliency(self, _mesh, sight, options):
        """(n,) f8 in 0..1 on the vertices."""
        return sight.on_vertices(self.fused(sight, options), options.smoothing)

    def candidates(self, sight, options, count):
        """The points of each view, before they are merged: (vertices, values, strong), each (c,)."""
        values = self.fused(sight, options)
        select, radius = SELECTIONS[options.selection], options.radius * sight.pixels_per_unit
        parts = []
        for view in range(len(sight.viewpoints)):
            image, ids = sight.image(values, view)
            picked = select(image, radius, count)
            strong = np.arange(len(picked.rows)) < picked.strong
            parts.append((ids[picked.rows, picked.columns], picked.values, strong))
        return tuple(np.concatenate(part) for part in zip(*parts, strict=True))

    def find(self, mesh, sight, options, count=None):
        """Found points; count None gives the strong ones alone."""
        saliency = self.saliency(mesh, sight, options)
        points, strong = merge_views(mesh, *self.candidates(sight, options, count), options.radius)
        if count is not None:
            points = continue_on_surface(mesh, points, saliency, options.radius, count)
        return Found(points, min(strong, len(points)), saliency)


class Weighted(Fused):
    """All nine channels with the weights of that name (T eq. 3.9), published or learned."""

    def __init__(self, name, channels):
        super().__init__(channels)
        self.learned = name

    def fused(self, sight, options):
        return fuse(self.maps(sight), options.learned.weights[self.learned])


class Machine(Fused):
    """The SVM of that name on the channels of each pixel (T3.2.3).

    It sees the pixels of the stored maps one by one, where the thesis shrinks them to 200 x 200, predicts and
    enlarges the answer: the same function, without the blur of two resizings.
    """

    def __init__(self, name, channels):
        super().__init__(channels)
        self.learned = name

    def fused(self, sight, options):
        models = options.learned.svms[self.learned]
        rows = np.stack(list(self.maps(sight).values()), axis=1)
        if len(models) == 1:
            return next(iter(models.values())).predict(rows)
        values = np.zeros(len(rows))
        for view, model in models.items():
            part = sight.pixels_of(view)
            values[part] = model.predict(rows[part])
        return values


class Merged(Fused):
    """The points of several methods together; the saliency is the first one's (the thesis's names in ...P, T3.1.5)."""

    def __init__(self, *parts):
        super().__init__(dict.fromkeys(channel for part in parts for channel in part.channels))
        self._parts = parts

    def fused(self, sight, options):
        return self._parts[0].fused(sight, options)

    def candidates(self, sight, options, count):
        found = [part.candidates(sight, options, count) for part in self._parts]
        return tuple(np.concatenate(part) for part in zip(*found, strict=True))
