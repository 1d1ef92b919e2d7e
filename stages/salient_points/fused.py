"""Methods that fuse conspicuity maps."""

import numpy as np

from .fuse import fuse
from .merge import continue_on_surface, merge_views
from .options import SELECTIONS, Found


class Fused:
    """An average of channels, plain (T eq. 3.8) or with the weights of the options (T eq. 3.9)."""

    def __init__(self, channels, weighted=False):
        self.channels, self._weighted = tuple(channels), weighted

    def fused(self, sight, options):
        """(p,) f8: the saliency map of all views, pixel by pixel."""
        for what, given in (("map", sight.maps), ("weight", options.weights if self._weighted else self.channels)):
            missing = [channel for channel in self.channels if channel not in given]
            if missing:
                raise ValueError(f"no {what} for {', '.join(missing)}: this method needs {', '.join(self.channels)}")
        maps = {channel: sight.maps[channel] for channel in self.channels}
        return fuse(maps, options.weights if self._weighted else None)

    def saliency(self, sight, options):
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
        saliency = self.saliency(sight, options)
        points, strong = merge_views(mesh, *self.candidates(sight, options, count), options.radius)
        if count is not None:
            points = continue_on_surface(mesh, points, saliency, options.radius, count)
        return Found(points, min(strong, len(points)), saliency)


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
