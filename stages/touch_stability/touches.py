"""The touches of one object, which can be repeated under changed conditions."""

from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, press_at, sensor_axes, sensor_normals


class Touches:
    """Touches of a Mesh at vertices (k,) by an array of `cells`, `pitch` units apart.

    name: the object's, for the random numbers; saliency: (n,) f8 in 0..1 per vertex, for simplification weighted by
    saliency; levels: {name of a simplified mesh: Mesh}, of data/SET/lod. `positions` (k, 3), `normals` (k, 3) and
    `axes` (k, 3, 3) are those of the undisturbed array, `images` (k, rows, cols) its imprints.
    """

    def __init__(
        self,
        name: str,
        mesh: Mesh,
        vertices: np.ndarray,
        cells: tuple[int, int],
        pitch: float,
        saliency: np.ndarray | None = None,
        levels: dict[str, Mesh] | None = None,
        seed: int = 0,
    ) -> None:
        self.name, self.mesh, self.cells, self.pitch = name, mesh, cells, pitch
        self.saliency, self.levels, self._seed = saliency, levels or {}, seed
        self.surface = Surface(mesh)
        self.positions = mesh.vertices[vertices]
        self.normals = sensor_normals(mesh, vertices)
        self.axes = sensor_axes(self.normals)

    @cached_property
    def images(self) -> np.ndarray:
        """(k, rows, cols) f4 in 0..1: the undisturbed imprints."""
        return self.press()

    def press(
        self,
        positions: np.ndarray | None = None,
        axes: np.ndarray | None = None,
        surface: Surface | None = None,
        pitch: float | None = None,
    ) -> np.ndarray:
        """(k, rows, cols) f4: the imprints with the given conditions, by default those of the undisturbed array."""
        return press_at(
            self.surface if surface is None else surface,
            self.positions if positions is None else positions,
            self.axes if axes is None else axes,
            self.cells,
            self.pitch if pitch is None else pitch,
        )

    def random(self, what: str, draw: int) -> np.random.Generator:
        """A random generator for one perturbation of this object; draw: the number of the repetition."""
        return rng(self._seed, f"{self.name} {what} {draw}")


def rotations_about(axis: np.ndarray, degrees: ArrayLike) -> np.ndarray:
    """(..., 3, 3) rotations about unit axes (..., 3) by `degrees` (...,): Rodrigues' formula."""
    x, y, z = np.moveaxis(np.asarray(axis, dtype=np.float64), -1, 0)
    zero, angle = np.zeros_like(x), np.radians(degrees)[..., None, None]
    cross = np.stack([np.stack(row, -1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))], -2)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)
