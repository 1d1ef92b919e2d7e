"""The touches of one object, ready to be made again under other circumstances."""

from functools import cached_property

import numpy as np

from stages.imprints import Surface, press_at, sensor_axes, sensor_normals
from stages.kit.rng import rng


class Touches:
    """Touches of a Mesh at vertices (k,) by an array of `cells`, `pitch` units apart.

    name: the object's, for the random numbers; saliency: (n,) f8 in 0..1 a vertex, for simplification that spares what
    is salient; levels: {name of a simplified mesh: Mesh}, see data/lod. `positions` (k, 3), `normals` (k, 3), `axes`
    (k, 3, 3) are where and how the array stands; `images` (k, rows, cols) what it feels there, undisturbed.
    """

    def __init__(self, name, mesh, vertices, cells, pitch, saliency=None, levels=None, seed=0):
        self.name, self.mesh, self.cells, self.pitch = name, mesh, tuple(cells), pitch
        self.saliency, self.levels, self._seed = saliency, levels or {}, seed
        self.surface = Surface(mesh)
        self.positions = mesh.vertices[vertices]
        self.normals = sensor_normals(mesh, vertices)
        self.axes = sensor_axes(self.normals)

    @cached_property
    def images(self):
        """(k, rows, cols) f4 in 0..1: the undisturbed imprints."""
        return self.press()

    def press(self, positions=None, axes=None, surface=None, pitch=None):
        """(k, rows, cols) f4: the imprints with some of the circumstances changed."""
        return press_at(
            self.surface if surface is None else surface,
            self.positions if positions is None else positions,
            self.axes if axes is None else axes,
            self.cells,
            self.pitch if pitch is None else pitch,
        )

    def random(self, what, draw):
        """A generator for one perturbation of this object; draw: the number of the repeat."""
        return rng(self._seed, f"{self.name} {what} {draw}")


def about(axis, degrees):
    """(..., 3, 3) rotations about unit axes (..., 3) by `degrees` (...,): Rodrigues' formula."""
    x, y, z = np.moveaxis(np.asarray(axis, dtype=np.float64), -1, 0)
    zero, angle = np.zeros_like(x), np.radians(degrees)[..., None, None]
    cross = np.stack([np.stack(row, -1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))], -2)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)
