"""What a perturbation makes of a mesh."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from stages.kit import Mesh


@dataclass(frozen=True)
class Conditions:
    """How a mesh is looked at: light in degrees off the camera, background from 0 (black) to 1 (white).

    rows: share of the image's rows that is rendered. filled: the background is kept out of the maps.
    """

    light: float = 0.0
    background: float = 0.0
    rows: float = 1.0
    filled: bool = True


@dataclass(frozen=True, eq=False)
class Perturbed:
    """mesh: in a frame of its own, to be normalised before a look; conditions: of that look.

    places (n, 3): where on the original mesh each of its vertices lies, in the original's frame.
    """

    mesh: Mesh
    places: np.ndarray
    conditions: Conditions = Conditions()


@dataclass(frozen=True)
class Perturbation:
    """unit: of the severity; unharmed: the severity that changes nothing.

    apply(mesh, severity, generator) -> Perturbed. The generator is at its start for each severity, so that the
    severities differ in strength alone. ValueError for a severity out of range, or a mesh that cannot be so changed.
    """

    unit: str
    unharmed: float
    apply: Callable[[Mesh, float, np.random.Generator], Perturbed]


def in_range(severity, low, high, what):
    """The severity; ValueError that names what it is when it lies outside low..high."""
    if not low <= severity <= high:
        raise ValueError(f"{what} must lie in {low:g}..{high:g}, got {severity:g}")
    return severity


def same_places(mesh, conditions):
    """The mesh as it is, looked at under other conditions."""
    return Perturbed(mesh, mesh.vertices, conditions)
