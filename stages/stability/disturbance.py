"""A disturbance of an object: a perturbation at one severity, or several one after the other, in one draw."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.disturb.objects import PERTURBATIONS
from haptic_glance.disturb.perturbed import Conditions, Perturbed
from haptic_glance.lod.errors import surface_index
from haptic_glance.mesh.mesh import Mesh

AND = "+"  # between the names of a pair


@dataclass(frozen=True)
class Disturbance:
    """parts: perturbations with their severities, in the order in which they are applied.

    draw: which random numbers; those of a perturbation are the same alone and in a pair.
    """

    parts: tuple[tuple[str, float], ...]
    draw: int = 0

    @property
    def name(self) -> str:
        """The name of the perturbation, or those of a pair: `noise+tilt`."""
        return AND.join(name for name, _ in self.parts)

    @property
    def severity(self) -> float | None:
        """The severity of a single perturbation; None of a pair, whose parts have each their own unit."""
        return self.parts[0][1] if len(self.parts) == 1 else None

    @property
    def random(self) -> bool:
        """Whether another draw gives another result."""
        return any(PERTURBATIONS[name].random_draws for name, _ in self.parts)

    def __str__(self) -> str:
        text = " and ".join(f"{name} {severity:g}" for name, severity in self.parts)
        return f"{text} draw {self.draw}" if self.draw else text

    def apply(self, mesh: Mesh, name: str, seed: int) -> Perturbed:
        """The mesh of the object `name` disturbed; ValueError where it cannot be disturbed in this way."""
        changed = Perturbed(mesh, mesh.vertices)
        for perturbation, severity in self.parts:
            key = f"{name} {perturbation} draw {self.draw}" if self.draw else f"{name} {perturbation}"
            step = PERTURBATIONS[perturbation].apply(changed.mesh, severity, rng(seed, key))
            changed = _after(changed, step)
        return changed


def _after(first: Perturbed, second: Perturbed) -> Perturbed:
    """A Perturbed of a Perturbed: places and conditions of both."""
    places = first.original_positions
    if second.original_positions is not first.mesh.vertices:
        places = _carried(first.mesh, places, second.original_positions)
    changed = {
        field.name: value
        for field in fields(Conditions)
        if (value := getattr(second.conditions, field.name)) != field.default
    }
    return Perturbed(second.mesh, places, replace(first.conditions, **changed))


def _carried(mesh: Mesh, values: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(k, 3): values (n, 3) of the vertices, interpolated at the places of the mesh nearest to points (k, 3)."""
    if values is mesh.vertices:
        return points
    surface, points = surface_index(mesh), np.ascontiguousarray(points, dtype=np.float64)
    faces = surface.nearest(points)[1]
    return np.einsum("ij,ijk->ik", surface.weights(points, faces), values[mesh.faces[faces]])


def disturbances(parts: Sequence[tuple[str, float]], draws: int) -> list[Disturbance]:
    """The draws of a disturbance: one where nothing is drawn."""
    first = Disturbance(tuple(parts))
    return [replace(first, draw=draw) for draw in range(draws if first.random else 1)]


def parts_of(pair: str, middle: Mapping[str, float]) -> list[tuple[str, float]]:
    """The parts of a pair `noise+tilt`, each at its middle severity."""
    return [(name, middle[name]) for name in pair.split(AND)]
