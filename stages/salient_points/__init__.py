"""Finds the salient points of a data set."""

from dataclasses import dataclass


@dataclass
class Params:
    """The methods that find the points, and their number."""

    methods: list[str]  # names of METHODS in haptic_glance/look/points/methods.py
    count: int
    selection: str
    radius: float
    smoothing: float
