"""Names of the axis that points up, rotations that turn it to +z, and directions spread evenly over the sphere."""

from collections.abc import Sequence

import numpy as np

Axis = str | Sequence[float] | np.ndarray
AUTO = "auto"  # nobody has said which axis points up: the shape decides (haptic_glance.mesh.upright)
AXES: tuple[str, ...] = ("x", "y", "z", "-x", "-y", "-z")
ALLOWED = f"{', '.join(AXES)}, {AUTO}, or a vector of three numbers that is not zero, such as 0,1,1"
SNAP = 1e-6  # of a unit vector: an axis that differs by less from a coordinate axis is that axis

# Rows are the new x, y, z in terms of the old axes. Each matrix is a rotation, so no mesh is mirrored.
TO_Z_UP = {
    "x": np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]]),
    "y": np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]]),
    "z": np.eye(3, dtype=int),
}
TO_Z_UP |= {f"-{name}": turn[[1, 0, 2]] * [[1], [1], [-1]] for name, turn in TO_Z_UP.items()}


def axis_named(up: Axis) -> str:
    """The name of an axis: one of AXES, `auto`, or the three components of another unit vector as text, `0.6,0,0.8`.

    up: a name in lower or upper case, with or without a sign, or a vector of any length, as numbers or as such a text.
    Raises ValueError, which names the allowed values, for anything else.
    """
    name = up.strip().lower().removeprefix("+") if isinstance(up, str) else ""
    if name in (*AXES, AUTO):
        return name
    try:
        vector = np.array(name.split(",") if isinstance(up, str) else up, dtype=np.float64)
    except (TypeError, ValueError):
        vector = np.zeros(0)
    if vector.shape != (3,) or not np.isfinite(vector).all() or not vector.any():
        raise ValueError(f"unknown up axis {up!r}: choose one of {ALLOWED}")
    largest = float(np.abs(vector).max())
    shrunk = vector / largest  # whose square does not overflow
    size = float(np.linalg.norm(shrunk))
    if abs(size * largest - 1) > SNAP:  # else it may be a name's own, which stays as it is
        vector = shrunk / size
    longest = int(np.abs(vector).argmax())
    if np.abs(np.delete(vector, longest)).max() < SNAP:
        return f"{'-' if vector[longest] < 0 else ''}{'xyz'[longest]}"
    return ",".join(f"{round(value, 6) + 0.0:g}" for value in vector.tolist())


def to_z_up(axis: str) -> np.ndarray:
    """(3, 3) rotation that turns an axis of `axis_named`, but `auto`, to +z: rows are the new axes in the old frame."""
    if axis in TO_Z_UP:
        return TO_Z_UP[axis]
    if axis == AUTO:
        raise ValueError('the axis that points up is not known: name it, such as "y" or "z"')
    up = np.array(axis.split(","), dtype=np.float64)
    up /= np.linalg.norm(up)
    first = np.cross(np.eye(3)[np.abs(up).argmin()], up)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(up, first), up])


def directions(count: int) -> np.ndarray:
    """(count, 3) unit vectors: a Fibonacci lattice."""
    k = np.arange(count) + 0.5
    height, turn = 1 - 2 * k / count, np.pi * (1 + 5**0.5) * k
    across = np.sqrt(1 - height**2)
    return np.stack([np.cos(turn) * across, np.sin(turn) * across, height], axis=1)
