"""Finds the salient points of a data set."""

from dataclasses import dataclass


@dataclass
class Params:
    """What finds the points, and how many."""

    methods: list[str]  # names of METHODS in haptic_glance/look/points/methods.py
    count: int
    selection: str
    radius: float
    smoothing: float
