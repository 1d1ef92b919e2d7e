"""Contours followed with the pressure array, blindly and through salient points (T4.4.6)."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `contours` of params.yaml."""

    strategies: list[str]  # how planes are chosen: random (blind), or a method of salient_points.methods
    count: int  # sequences per object and strategy
    frames: int  # touches along a contour (T4.4.6)
    cells: list[int]  # rows, columns of the pressure array (T4.4.3)
    pitch: float  # distance of two sensels, in units of the mesh, where the array fits
