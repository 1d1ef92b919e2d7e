"""The types of a perturbation and of its result."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from haptic_glance.mesh.mesh import Mesh


@dataclass(frozen=True)
class Conditions:
    """How a mesh is rendered: light in degrees off the camera, background from 0 (black) to 1 (white).

    rows: the image's rows as a share of the usual number. filled: the background is kept out of the maps.
    """

    light: float = 0.0
    background: float = 0.0
    rows: float = 1.0
    filled: bool = True


@dataclass(frozen=True, eq=False)
class Perturbed:
    """A perturbed mesh, in a frame of its own (normalise it before rendering), and the conditions of rendering.

    original_positions (n, 3): where each of its vertices lies on the original mesh, in the original's frame.
    """

    mesh: Mesh
    original_positions: np.ndarray
    conditions: Conditions = Conditions()


@dataclass(frozen=True)
class Perturbation:
    """One way to perturb a mesh: apply(mesh, severity, generator) -> Perturbed.

    unit: of the severity; unharmed: the severity that changes nothing. The generator starts anew for each severity, so
    that severities differ in strength alone. apply raises ValueError for a severity out of range, or a mesh that cannot
    be changed in this way.
    """

    unit: str
    unharmed: float
    apply: Callable[[Mesh, float, np.random.Generator], Perturbed]


def in_range(severity: float, low: float, high: float, name: str) -> float:
    """The severity; raises ValueError, naming it as `name`, where it lies outside low..high."""
    if not low <= severity <= high:
        raise ValueError(f"{name} must lie in {low:g}..{high:g}, got {severity:g}")
    return severity


def under_conditions(mesh: Mesh, conditions: Conditions) -> Perturbed:
    """The mesh as it is, rendered under other conditions."""
    return Perturbed(mesh, mesh.vertices, conditions)
