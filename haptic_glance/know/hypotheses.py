"""Hypotheses: an object and its rotation, and a shift and a size where these are unknown."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Hypotheses:
    """h hypotheses: objects (h,) and poses (h,), numbers of a library; rotations (h, 3, 3); shifts (h, 3); sizes (h,).

    poses: the pose of the grid from which a hypothesis comes. Shifts are in diameters, sizes in shares of the mesh's.
    is_grid: whether these are all objects in all poses of the grid, in order, with no shift and size 1.
    """

    objects: np.ndarray
    poses: np.ndarray
    rotations: np.ndarray
    shifts: np.ndarray
    sizes: np.ndarray
    is_grid: bool = False

    def __len__(self) -> int:
        return len(self.objects)

    def __getitem__(self, ids: np.ndarray) -> "Hypotheses":
        """The hypotheses with some numbers."""
        return Hypotheses(self.objects[ids], self.poses[ids], self.rotations[ids], self.shifts[ids], self.sizes[ids])

    def to_object(self, origins: np.ndarray, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Lines (k, 3), (k, 3, 3) as each hypothesis' object has them in its frame: (h, k, 3), (h, k, 3, 3)."""
        away = (origins[None] - self.shifts[:, None]) @ self.rotations
        return away / self.sizes[:, None, None], axes[None] @ self.rotations[:, None]


def grid_hypotheses(objects: int, rotations: np.ndarray) -> Hypotheses:
    """All objects in all rotations (p, 3, 3), those of the first object first."""
    size = objects * len(rotations)
    return Hypotheses(
        np.repeat(np.arange(objects), len(rotations)),
        np.tile(np.arange(len(rotations)), objects),
        np.tile(rotations, (objects, 1, 1)),
        np.zeros((size, 3)),
        np.ones(size),
        is_grid=True,
    )
