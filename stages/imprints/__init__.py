"""Presses the pressure array on every object."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `imprints` of params.yaml."""

    methods: list[str]  # of salient_points, at whose points the object is touched
    cells: list[int]  # rows and columns of the array; T4.3 has 16 x 16 and 32 x 32
    pitch: float  # distance of neighbouring cells, in units of the object (its bounding sphere has radius 0.5)
    contact: str  # tangent: the array stands at the point; rigid: it rests on what it meets first; contours: T4.2.3.1
