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

    broken: list[str]  # objects whose broken copies are simplified, of those below
    objects: list[str]  # objects to disturb; the first `most` of all where none of these is there
    most: int  # how many objects at most
    methods: list[str]  # names of METHODS in haptic_glance/look/points/methods.py
    count: int  # points an object and method: the same number for all, since chance hits grow with it
    size: list[int]  # rows, columns of the views
    perturbations: list[str]  # names of stages.stability.PERTURBATIONS
    severities: dict[str, list[float]]  # of each perturbation, in its own unit, from mild to harsh
    draws: int  # of a disturbance that draws random numbers; what is measured is their mean
    pairs: list[str]  # perturbations one after the other at their middle severities, in one draw: noise+tilt
    used: list[str]  # methods whose points are used to simplify and to touch the undisturbed object
