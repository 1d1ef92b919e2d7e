"""Poses that an object may have, and lines along which the hand may come, so that one press serves many poses.

Poses are the elements of a finite group of rotations, times a few further ones. The lines are closed under the same
group. A line seen from an object in a pose is then again one of the lines seen from the object in few poses. So a table
of 768 touches an object holds what it feels like along 768 lines in each of 48 azimuths, and a table of 5,760 what it
feels like along 120 lines in each of 2,880 rotations.
"""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from haptic_glance.touch import sensor_axes

POSES = ("fixed", "turned", "any")
AZIMUTHS = 48  # of an object that stands: 7.5 degrees apart
BASES = 16  # lines that differ by more than an azimuth
TILTED_BASES, FURTHER = 2, 48  # lines that differ by more than a rotation of the icosahedron; further rotations
LOWEST = -0.2  # sine of the lowest elevation from which the hand comes to an object that stands
REACH = 0.28  # of the diameter: how far beside the centre a line may pass
GOLDEN = (1 + 5**0.5) / 2
DRAWN = 8000  # rotations from which the further ones are chosen


@dataclass(frozen=True)
class PoseGrid:
    """Poses group[g] @ further[k], numbered k * len(group) + g; lines group[c] applied to bases[m], m * len(group) + c.

    group (g, 3, 3), further (k, 3, 3): rotations; origins (m, 3), axes (m, 3, 3): of the bases, in diameters.
    poses: which elements of the group the object may have.
    """

    group: np.ndarray
    further: np.ndarray
    origins: np.ndarray
    axes: np.ndarray
    poses: np.ndarray

    @property
    def size(self) -> int:
        """The number of poses."""
        return len(self.further) * len(self.poses)

    @property
    def lines(self) -> int:
        """The number of lines."""
        return len(self.origins) * len(self.group)

    @cached_property
    def rotations(self) -> np.ndarray:
        """(poses, 3, 3)."""
        return np.einsum("gij,kjl->kgil", self.group[self.poses], self.further).reshape(-1, 3, 3)

    @cached_property
    def line_origins(self) -> np.ndarray:
        """(lines, 3), in diameters."""
        return np.einsum("cij,mj->mci", self.group, self.origins).reshape(-1, 3)

    @cached_property
    def line_axes(self) -> np.ndarray:
        """(lines, 3, 3)."""
        return np.einsum("cij,maj->mcai", self.group, self.axes).reshape(-1, 3, 3)

    @cached_property
    def seen(self) -> np.ndarray:
        """(poses of the group, group): the element by which line c is the line seen from an object in pose g."""
        products = np.einsum("gji,cjk->gcik", self.group[self.poses], self.group)  # inverse of g, times c
        flat = self.group.reshape(len(self.group), 9)
        return np.argmax(products.reshape(*products.shape[:2], 9) @ flat.T, axis=2)

    def lines_of_object(self) -> tuple[np.ndarray, np.ndarray]:
        """(origins, axes) of all lines (k, m, c) as they are seen from an object in its own frame."""
        origins = self.line_origins @ self.further  # row vectors: the inverse rotation
        axes = self.line_axes @ self.further[:, None]
        return origins.reshape(-1, 3), axes.reshape(-1, 3, 3)


@cache
def pose_grid(pose: str, start: float) -> PoseGrid:
    """The PoseGrid of a name in POSES, whose lines begin `start` diameters from the plane through the centre."""
    if pose not in POSES:
        raise ValueError(f"unknown pose {pose!r}: choose one of {', '.join(POSES)}")
    if pose == "any":
        group = Rotation.create_group("I").as_matrix()
        steps = (np.arange(TILTED_BASES) + 0.5) / TILTED_BASES
        normals = _on_sphere(1 - 2 * steps)
        further = _further(group)
    else:
        angles = 2 * np.pi * np.arange(AZIMUTHS) / AZIMUTHS
        group = Rotation.from_rotvec(np.outer(angles, [0, 0, 1])).as_matrix()
        normals = _on_sphere(1 - (1 - LOWEST) * (np.arange(BASES) + 0.5) / BASES)
        further = np.eye(3)[None]
    axes = sensor_axes(normals)
    number = np.arange(len(normals))
    offset, angle = REACH * np.sqrt((number * GOLDEN + 0.5) % 1), 2 * np.pi * ((number * GOLDEN**2) % 1)
    beside = (offset * np.cos(angle))[:, None] * axes[:, 0] + (offset * np.sin(angle))[:, None] * axes[:, 1]
    poses = np.arange(1) if pose == "fixed" else np.arange(len(group))
    return PoseGrid(group, further, beside + start * normals, axes, poses)


def _on_sphere(heights):
    """(n, 3) unit vectors of given heights, each the golden angle further round."""
    angles, radii = 2 * np.pi * np.arange(len(heights)) / GOLDEN, np.sqrt(1 - heights**2)
    return np.stack([radii * np.cos(angles), radii * np.sin(angles), heights], axis=1)


def _further(group):
    """(FURTHER, 3, 3) rotations that make the group an even grid of rotations, each the farthest from those before."""
    elements = Rotation.from_matrix(group).as_quat()
    drawn = even_rotations(DRAWN).as_quat()
    chosen, closeness = [np.array([0.0, 0, 0, 1])], np.zeros(DRAWN)
    while True:
        products = (Rotation.from_quat(elements) * Rotation.from_quat(chosen[-1])).as_quat()
        closeness = np.maximum(closeness, np.abs(drawn @ products.T).max(axis=1))
        if len(chosen) == FURTHER:
            return Rotation.from_quat(chosen).as_matrix()
        chosen.append(drawn[closeness.argmin()])


def even_rotations(count: int) -> Rotation:
    """`count` rotations spread evenly (Alexa, Super-Fibonacci spirals, CVPR 2022)."""
    steps = np.arange(count) + 0.5
    first, second = np.sqrt(steps / count), np.sqrt(1 - steps / count)
    alpha, beta = 2 * np.pi * steps / np.sqrt(2), 2 * np.pi * steps / 1.533751168755204288118041
    parts = first * np.sin(alpha), first * np.cos(alpha), second * np.sin(beta), second * np.cos(beta)
    return Rotation.from_quat(np.stack(parts, axis=1))
