"""Stability: what each method still finds when the mesh, the light or the image changes, and where it breaks."""

from dataclasses import dataclass

COLUMNS = {
    "perturbation": "how the object, the light or the image was disturbed; none: as it is",
    "severity": "how much, in the perturbation's unit",
}


@dataclass
class Params:
    """Section `stability` of params.yaml."""

    objects: list[str]
    most: int
    methods: list[str]
    count: int
    size: list[int]
    perturbations: list[str]
    severities: dict[str, list[float]]
