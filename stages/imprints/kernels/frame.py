"""The frame of an array for kernels, which converts a point to column, row and height."""

from collections import namedtuple

import numpy as np

from .jit import helper

SLACK = 1e-12  # of the mesh's diagonal: how far a face extends beyond its edges, so that no column passes between two
GRAZING = 1e-12  # sine of a face's angle to the normal, below which a column has no single intersection with it

# centre (3,); right, down (3,) in cells per unit, normal (3,) in units; column, row of the centre; side 1, or -1 for
# upwards; lift, slack in units, margin the slack in cells; grazing the area in cells below which an area of 1 grazes.
Frame = namedtuple("Frame", "centre right down normal column row side lift slack margin grazing")


@helper
def frame_of(
    centre: np.ndarray,
    axes: np.ndarray,
    pitch: float,
    rows: int,
    columns: int,
    side: float,
    lift: float,
    diagonal: float,
) -> Frame:
    """The Frame of an array; for side -1 heights count down, so that what is above comes first."""
    over, slack = 1 / pitch, SLACK * (diagonal + (rows + columns) * pitch)
    return Frame(
        (centre[0], centre[1], centre[2]),
        (axes[0, 0] * over, axes[0, 1] * over, axes[0, 2] * over),
        (-axes[1, 0] * over, -axes[1, 1] * over, -axes[1, 2] * over),
        (side * axes[2, 0], side * axes[2, 1], side * axes[2, 2]),
        (columns - 1) / 2,
        (rows - 1) / 2,
        side,
        lift,
        slack,
        slack * over,
        GRAZING * over * over,
    )


@helper
def along(axis: tuple[float, float, float], x: float, y: float, z: float) -> float:
    """The dot product of a vector and an axis."""
    return axis[0] * x + axis[1] * y + axis[2] * z


@helper
def half_width(axis: tuple[float, float, float], x: float, y: float, z: float) -> float:
    """The half extent along an axis of a box with half widths x, y, z."""
    return abs(axis[0]) * x + abs(axis[1]) * y + abs(axis[2]) * z
