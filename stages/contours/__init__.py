"""Contours followed with the pressure array, blindly and through salient points (T4.4.6)."""

from dataclasses import dataclass


@dataclass
class Params:
    """Section `contours` of params.yaml."""

    strategies: list[str]
    count: int
    frames: int
    cells: list[int]
    pitch: float
