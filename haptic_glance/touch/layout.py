"""Taxels at any places: hexagonal arrays, fingertips, and layouts from a file."""

import csv
import io
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.base.text import text_of
from haptic_glance.mesh.mesh import Mesh, unit

from .distances import check_places
from .force import check_unit, checked_depths, forces
from .kernels.faces import Taxels
from .skin import Layer
from .surface import Surface, as_surface

COLUMNS = ("x", "y", "z", "nx", "ny", "nz", "area")


@dataclass(frozen=True)
class Layout:
    """Taxels in the frame of an array, whose axes are right, up and normal, away from the object.

    positions (n, 3) in metres; normals (n, 3), out of the sensor, so that nz is below 0 for a taxel that faces the
    object; areas (n,) in m2. Raises ValueError for no taxels, two at one position, an area of 0 or below, and a normal
    without length.
    """

    positions: np.ndarray
    normals: np.ndarray
    areas: np.ndarray

    def __post_init__(self) -> None:
        for name, shape in (("positions", (3,)), ("normals", (3,)), ("areas", ())):
            values = np.array(getattr(self, name), dtype=np.float64)  # its own, as `cells` is computed once
            if values.shape != (np.size(self.areas), *shape) or not np.isfinite(values).all():
                raise ValueError(f"layout: {name} must be finite and of shape (n, 3), areas (n,), got {values.shape}")
            object.__setattr__(self, name, values)
        if len(self.areas) == 0:
            raise ValueError("layout: there are no taxels; give one a row")
        _, first, place = np.unique(self.positions, axis=0, return_index=True, return_inverse=True)
        earlier = first[place.ravel()]
        if len(twins := np.flatnonzero(earlier < np.arange(len(earlier)))):
            raise ValueError(f"layout: taxels {earlier[twins[0]] + 1} and {twins[0] + 1} are at one place; remove one")
        if len(wrong := np.flatnonzero(self.areas <= 0)):
            raise ValueError(f"layout: taxel {wrong[0] + 1} has an area of {self.areas[wrong[0]]:g}; give m2 above 0")
        object.__setattr__(self, "normals", unit(self.normals))
        if len(wrong := np.flatnonzero(~self.normals.any(axis=1))):
            raise ValueError(f"layout: taxel {wrong[0] + 1} has a normal without length; give its direction")
        if not (self.cosines > 0).any():
            raise ValueError("layout: no taxel faces the object; normals point out of the sensor, with nz below 0")

    @property
    def cosines(self) -> np.ndarray:
        """(n,) cosines of the normals to the array's approach; 0 where a taxel faces away."""
        return np.maximum(-self.normals[:, 2], 0.0)

    @cached_property
    def cells(self) -> tuple[tuple[int, int], float, tuple[float, float, float], Taxels]:
        """((rows, columns), pitch, (x, y, least z), Taxels): a grid of about a taxel a cell, its middle at x, y.

        It holds the taxels that face the object.
        """
        facing = np.flatnonzero(self.cosines > 0)
        low, high = (least(self.positions[facing], axis=0) for least in (np.min, np.max))
        (x, y, _), (width, height, _) = (low + high) / 2, high - low
        pitch = max(np.sqrt(width * height / len(facing)), max(width, height) / len(facing)) or 1.0
        rows, columns = round(height / pitch) + 1, round(width / pitch) + 1
        right = (self.positions[facing, 0] - x) / pitch + (columns - 1) / 2
        down = (y - self.positions[facing, 1]) / pitch + (rows - 1) / 2
        cell = np.rint(down).astype(np.int64) * columns + np.rint(right).astype(np.int64)
        order = np.argsort(cell, kind="stable")
        first = np.searchsorted(cell[order], np.arange(rows * columns + 1))
        rise = low[2] - self.positions[facing, 2]
        grid = Taxels(right[order], down[order], rise[order], facing[order], first)
        return (rows, columns), float(pitch), (x, y, low[2]), grid


def read_layout(path: str | Path) -> Layout:
    """Reads a layout of taxels from a CSV file.

    Parameters
    ----------
    path : path
        A row a taxel: columns x, y, z, nx, ny, nz in metres and area in square metres, in any order. Semicolons or
        tabs may separate the columns; commas may then stand before decimals.

    Returns
    -------
    Layout
        Positions, normals and areas of the taxels.

    Raises
    ------
    ValueError
        For a missing or repeated column, and for a value that is no number.
    """
    text = text_of(Path(path).read_bytes())
    header = text.partition("\n")[0]
    delimiter = next((mark for mark in ";\t" if mark in header), ",")
    reader = csv.DictReader(io.StringIO(text, newline=""), delimiter=delimiter, skipinitialspace=True)
    names = [name.strip().lower() for name in reader.fieldnames or ()]
    if absent_columns := [name for name in COLUMNS if name not in names]:
        raise ValueError(f"{path}: no column {', '.join(absent_columns)}; a layout has {','.join(COLUMNS)}")
    if repeated := [name for name in COLUMNS if names.count(name) > 1]:
        raise ValueError(f"{path}: column {repeated[0]} occurs twice; remove one")
    reader.fieldnames = names
    rows = [_numbers(path, reader.line_num, row, delimiter) for row in reader]
    table = np.array(rows).reshape(len(rows), len(COLUMNS))
    try:
        return Layout(table[:, :3], table[:, 3:6], table[:, 6])
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def layout_forces(
    mesh: Mesh | Surface,
    centres: ArrayLike,
    axes: ArrayLike,
    layer: Layer,
    layout: Layout,
    load: ArrayLike | None = None,
    depth: ArrayLike | None = None,
    unit: float = 1.0,
) -> np.ndarray:
    """Forces along the normals of the taxels of a free layout, such as a curved fingertip.

    Parameters
    ----------
    mesh : Mesh, Surface or any input of `as_mesh`
        The object.
    centres : (k, 3) array_like
        Places of the layout, in units of the mesh.
    axes : (k, 3, 3) array_like
        Unit vectors right, up and normal; the approach is against the third.
    layer : Layer
        The layer on the taxels.
    layout : Layout
        The taxels, from `read_layout`.
    load, depth : float, str or (k,) array_like, optional
        Along the approach, as of `forces`.
    unit : float or str
        Metres that a unit of the mesh is long; `haptic_glance.layout_forces` also takes a name such as "mm".

    Returns
    -------
    (k, n) array of float
        Newtons. Rays are parallel to the approach, so that the forces of a curved sensor are those of small
        indentations.

    Raises
    ------
    ValueError
        As `forces` does, and for a unit that is no length.

    Warns
    -----
    UserWarning
        By `haptic_glance.layout_forces`, if only a wrong unit explains the sizes of the layout, the layer and the
        object.
    """
    check_unit(unit)
    centres, axes = check_places(centres, axes)
    depths = layer.thickness if depth is None else checked_depths(depth, len(centres))
    within = min(np.max(depths, initial=0.0), layer.thickness)
    gaps = layout_gaps(mesh, centres, axes, layout, layer, within, unit)
    return forces(gaps, layer, layout.areas, load, depth, layout.cosines)


def layout_gaps(
    mesh: Mesh | Surface, centres: np.ndarray, axes: np.ndarray, layout: Layout, layer: Layer, within: float,
    unit: float = 1.0,
) -> np.ndarray:  # fmt: skip
    """(k, n) metres that each taxel can still approach, as `gaps_at` of a rectangular array.

    inf where the mesh is not in its way, not `within` so many metres of the first contact, or it faces away. The
    approach begins as far off as the layout is wide. unit: metres that a unit of the mesh is long.
    """
    cells, pitch, (x, y, lowest), taxels = layout.cells
    start = layout.positions[:, 2].max() + np.ptp(layout.positions, axis=0).max() + layer.thickness
    places = centres, axes, cells, pitch / unit, np.array([x, y, start]) / unit
    taxels = taxels._replace(rise=taxels.rise / unit)
    gaps = as_surface(mesh).below_taxels(*places, within / unit, taxels, len(layout.areas))
    gaps -= (start - lowest) / unit
    gaps *= unit
    return gaps


def _numbers(path, line, row, delimiter):
    try:
        if None in row:
            raise ValueError("more values than columns")
        values = [float(row[name] if delimiter == "," else row[name].replace(",", ".")) for name in COLUMNS]
        if not np.isfinite(values).all():
            raise ValueError("NaN or infinite")
        return values
    except (AttributeError, TypeError, ValueError):
        raise ValueError(f"{path}: line {line} has a taxel that is not seven numbers: {','.join(COLUMNS)}") from None
