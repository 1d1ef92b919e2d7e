"""Contours followed with the pressure array, blindly and through salient points (T4.4.6)."""

from dataclasses import dataclass

from stages.engine.settings import setting


@dataclass
class Params:
    """Section `contours` of params.yaml."""

    strategies: list[str] = setting(
        ["random", "thesis_ssim", "glance"],
        "how planes are chosen: blind, or by a method of salient_points.methods",
    )
    count: int = setting(40, "sequences an object and strategy", least=1)
    frames: int = setting(25, "touches along a contour (T4.4.6)", least=1)
    cells: list[int] = setting([32, 32], "rows, columns of the pressure array (T4.4.3)", least=1)
    pitch: float = setting(0.01, "distance of two sensels where the array fits; less at saddles (T4.4.3)", above=0)
