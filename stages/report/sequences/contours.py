"""Contours drawn on the picture of an object: what the viewer sees in full, what is behind faintly."""

import numpy as np

from stages.imprints import contour
from stages.kit import RayScene
from stages.kit.camera import project
from stages.report.drawing import VIEWPOINT, picture, squared

ROWS = 420
CLEAR = 2e-3  # units along the view to come off the surface, before asking what hides a point


class Canvas:
    """Axes with an object's picture, on which places on the object can be drawn."""

    def __init__(self, axes, mesh, viewpoint=VIEWPOINT):
        image, (self.top, self.left) = squared(picture(mesh, viewpoint=viewpoint, rows=ROWS), margin=24)
        axes.imshow(image)
        axes.set_axis_off()
        self.axes, self.viewpoint, self.scene = axes, viewpoint, RayScene(mesh)

    def pixels(self, points):
        """(columns, rows) of points (k, 3) in the axes."""
        down, across, _ = project(points, self.viewpoint, (ROWS, ROWS))
        return across - self.left, down - self.top

    def widen(self, across, down):
        """Makes room for pixels (k,), (k,) beside the picture."""
        for values, low, high, limit in (
            (across, *self.axes.get_xlim(), lambda low, high: self.axes.set_xlim(low, high)),
            (down, *self.axes.get_ylim()[::-1], lambda low, high: self.axes.set_ylim(high, low)),
        ):
            limit(min(low, values.min()), max(high, values.max()))

    def line(self, points, colour, closed=True):
        """A line through points (k, 3) on the surface."""
        points = np.vstack([points, points[:1]]) if closed else points
        back = self.viewpoint.axes[2]
        middles = (points[:-1] + points[1:]) / 2 + CLEAR * back
        hidden = self.scene.cast(middles, np.broadcast_to(back, middles.shape)).hit
        across, down = self.pixels(points)
        for mask, style in ((hidden, {"lw": 0.8, "alpha": 0.45, "ls": (0, (2, 2))}), (~hidden, {"lw": 2.0})):
            # One stroke a run of segments that are alike, so that dashes do not start anew at each.
            bounds = np.flatnonzero(np.diff(np.r_[False, mask, False].astype(int)))
            for start, stop in bounds.reshape(-1, 2):
                self.axes.plot(across[start : stop + 1], down[start : stop + 1], color=colour, **style)


def followed(mesh, pair):
    """The Loop that was followed on the plane through the object's centre and a pair of vertices."""
    used = mesh.vertices[np.unique(mesh.faces)]
    return contour(mesh, [(used.min(axis=0) + used.max(axis=0)) / 2, *mesh.vertices[pair]])
