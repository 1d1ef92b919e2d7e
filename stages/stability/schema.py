"""Settings of the stability stage."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `stability` of params.yaml."""

    broken: list[str]  # objects whose broken copies are simplified, of those below
    objects: list[str]  # objects to disturb; the first `most` of all where none of these is there
    most: int  # how many objects at most
    methods: list[str]  # names of METHODS in stages/salient_points/methods.py
    count: int  # points an object and method: the same number for all, since chance hits grow with it
    size: list[int]  # rows, columns of the views
    perturbations: list[str]  # names of stages.stability.PERTURBATIONS
    severities: dict[str, list[float]]  # of each perturbation, in its own unit, from mild to harsh
