"""Stability: what each method still finds when the mesh, the light or the image changes, and where it breaks.

Also: what happens to broken meshes when they are simplified.
"""

from dataclasses import dataclass

COLUMNS = {
    "perturbation": "how the object, the light or the image was disturbed, or how the mesh was broken; none: as it is",
    "severity": "how much, in the perturbation's unit; of a simplification the number of faces asked for",
    "budget": "of a simplification: the target, a number or share of faces, or the smallest one that is feasible",
    "kept": "of a simplification: how many vertices are kept",
    "soft": "of a simplification: the weights of the vertices",
    "outcome": "of a simplification: valid, refused, ruined or crash",
    "limit": "of a simplification: the largest mean error that is not ruin, in diagonals",
}


@dataclass
class Params:
    """Section `stability` of params.yaml."""

    broken: list[str]
    objects: list[str]
    most: int
    methods: list[str]
    count: int
    size: list[int]
    perturbations: list[str]
    severities: dict[str, list[float]]
    draws: int
    pairs: list[str]
    used: list[str]
