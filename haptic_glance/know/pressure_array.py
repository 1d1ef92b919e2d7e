"""The pressure array of a hand: its cells, how deep it feels, and its noise; and one touch with it along a line."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.mesh.files import MeshLike, with_known_up
from haptic_glance.touch import Surface
from haptic_glance.touch.distances import check_array
from haptic_glance.touch.surface import as_surface


@dataclass(frozen=True)
class PressureArray:
    """A flat array of cells that moves along its normal until it meets the object.

    Parameters
    ----------
    cells : tuple of 2 ints
        Rows and columns.
    pitch : float
        Distance of neighbouring cells, in the unit of the meshes.
    depth : float
        How far below the first contact a cell still feels the surface, in the unit of the meshes.
    travel_noise : float
        Standard deviation of the travel until contact, in the unit of the meshes.
    relief_noise : float
        Standard deviation of what a cell measures, in the unit of the meshes.

    Raises
    ------
    ValueError
        For cells, lengths or noise out of range.

    Examples
    --------
    >>> from haptic_glance.know import PressureArray
    >>> PressureArray((8, 8), pitch=0.002, depth=0.005).cells  # metres
    (8, 8)
    """

    cells: tuple[int, int]
    pitch: float
    depth: float
    travel_noise: float = 0.0
    relief_noise: float = 0.0

    def __post_init__(self) -> None:
        cells, _, _ = check_array(self.cells, self.pitch, self.depth)
        object.__setattr__(self, "cells", cells)
        for name in ("travel_noise", "relief_noise"):
            value = getattr(self, name)
            if not (isinstance(value, int | float | np.number) and 0 <= float(value) < np.inf):
                raise ValueError(f"{name} must be a finite length of 0 or more, got {value!r}")

    def scaled(self, factor: float) -> "PressureArray":
        """The array with all lengths multiplied by a factor: in another unit."""
        lengths = (self.pitch, self.depth, self.travel_noise, self.relief_noise)
        return PressureArray(self.cells, *(factor * length for length in lengths))


MISSED = np.inf  # travel of a touch that meets nothing


def feel_lines(
    surface: Surface,
    origins: np.ndarray,
    axes: np.ndarray,
    array: PressureArray,
    sizes: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """(travels (k,), imprints (k, rows, cols)) of arrays that move from origins (k, 3) against their normals.

    axes (k, 3, 3): rows right, up and normal of each array, the normal against the movement. sizes (k,): of the object
    as shares of the mesh, whose frame the origins are in. A travel is MISSED where nothing is met. An imprint is how
    far the surface lies below the plane at first contact, at most `depth`.
    """
    scale = np.ones(len(origins)) if sizes is None else sizes
    window = array.depth / scale.min(initial=1.0)
    below = surface.first_below(origins, axes, array.cells, array.pitch / scale, window) * scale[:, None, None]
    travels = below.min(axis=(1, 2), initial=MISSED)
    met = np.isfinite(travels)
    imprints = np.minimum(below - np.where(met, travels, 0)[:, None, None], array.depth)
    return travels, imprints


@dataclass(frozen=True)
class Approach:
    """A line along which the hand moves until its array meets the object.

    Parameters
    ----------
    origin : (3,) array of float
        Where the middle of the array starts, in the unit of the meshes. The centre of the object is the origin.
    axes : (3, 3) array of float
        Rows right, up and normal of the array; it moves against its normal.
    array : PressureArray
        The array.

    Attributes
    ----------
    line : int
        The number of this line among the lines of the library, or -1 for a line of one's own.
    """

    origin: np.ndarray
    axes: np.ndarray
    array: PressureArray
    line: int = field(default=-1)

    @property
    def direction(self) -> np.ndarray:
        """(3,) unit vector along which the hand moves."""
        return -self.axes[2]

    @property
    def up(self) -> np.ndarray:
        """(3,) unit vector that is upwards on the array, from its last row to row 0."""
        return self.axes[1]

    def contact(self, travel: float) -> np.ndarray:
        """(3,) where the middle of the array is after a travel, in the unit of the meshes."""
        return self.origin + travel * self.direction

    def feel(self, mesh: "MeshLike | Surface", random: np.random.Generator | None = None) -> tuple[float, np.ndarray]:
        """Simulates the touch of a mesh.

        Parameters
        ----------
        mesh : Mesh, Surface or any input of `as_mesh`
            The object as it stands, in the unit of the library; `stand` centres and turns a mesh.
        random : numpy.random.Generator, optional
            Draws the noise of the array. None: the same numbers for the same line.

        Returns
        -------
        travel : float
            How far the hand moves until first contact; inf where it meets nothing.
        imprint : (rows, cols) array of float
            How far the surface lies below the array at each cell, from 0 to the array's depth.
        """
        surface = mesh if isinstance(mesh, Surface) else as_surface(with_known_up(mesh))
        (travel,), (imprint,) = feel_lines(surface, self.origin[None], self.axes[None], self.array)
        random = random or rng(0, (self.origin.round(9).tolist(), self.axes.round(9).tolist()))
        noise = random.normal(size=(1 + imprint.size))
        if np.isfinite(travel):
            travel = max(travel + self.array.travel_noise * noise[0], 0.0)
            imprint = imprint + self.array.relief_noise * noise[1:].reshape(imprint.shape)
        return float(travel), np.clip(imprint, 0, self.array.depth)


def check_touch(travel: float, imprint: Sequence | np.ndarray, array: PressureArray) -> tuple[float, np.ndarray]:
    """A travel and an imprint as numbers; ValueError that names what is wrong with them."""
    travel, imprint = float(travel), np.asarray(imprint, dtype=np.float64)
    if np.isnan(travel) or travel < 0:
        raise ValueError(f"the travel until contact must be 0 or more, or inf where nothing was met, got {travel}")
    if imprint.shape != array.cells:
        raise ValueError(f"the array has {array.cells} cells, the imprint has {imprint.shape}")
    if not (np.isfinite(imprint).all() and imprint.min() >= 0):
        raise ValueError("an imprint must hold finite lengths of 0 or more: 0 where the array meets the object first")
    return travel, np.minimum(imprint, array.depth)
