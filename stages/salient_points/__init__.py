"""Finds the salient points of a data set."""

from dataclasses import dataclass


@dataclass
class Params:
    """What finds the points, and how many."""

    methods: list[str]  # names of METHODS in haptic_glance/look/points/methods.py
    count: int  # points an object and method
    selection: str  # how points are taken from a saliency map: suppression (T3.2.5) or centroid (T3.1.2)
    radius: float  # least distance between points, in units of the mesh (bounding sphere 0.5)
    smoothing: float  # over which length the saliency on the vertices is smooth, same units
