"""Where an array stands, for kernels: what takes a point to column, row and height."""

from collections import namedtuple

from .jit import inlined

SLACK = 1e-12  # of the mesh's diagonal: so far a face reaches over its edges, so that no column slips between two
GRAZING = 1e-12  # sine of a face's angle to the normal, below which a column has no single crossing with it

# centre (3,); right, down (3,) in cells a unit, normal (3,) in units; column, row of the centre; side 1, or -1 to look
# up; lift, slack in units, margin the slack in cells; grazing the area in cells below which an area of 1 unit grazes.
Frame = namedtuple("Frame", "centre right down normal column row side lift slack margin grazing")


@inlined
def frame_of(centre, axes, pitch, rows, columns, side, lift, diagonal):
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


@inlined
def along(axis, x, y, z):
    """The product of a vector with an axis."""
    return axis[0] * x + axis[1] * y + axis[2] * z


@inlined
def half_width(axis, x, y, z):
    """How far a box of half widths x, y, z reaches along an axis."""
    return abs(axis[0]) * x + abs(axis[1]) * y + abs(axis[2]) * z
