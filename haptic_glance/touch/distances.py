"""Distances from the cells of the virtual pressure array to the surface (T4.3.1).

The array stands at the place (`tangent`) or rests on its first contact (`rigid`): "Obviously when working with a real
sensor such cases will prevent a direct contact of the sensor with object at interest point and the point with maximum
negative distance will directly touch the object" (T4.3.1). `tangent` is the thesis's array, which intersects the object
there. `rigid` is the plate that the sentence describes. On saddles the pitch shrinks until no cell is inside the object
(T4.4.3).
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.base.warner import warn_caller
from haptic_glance.mesh.mesh import Mesh

from .surface import Surface, as_surface, check_vertices, sensor_axes, sensor_normals

EYE = np.eye(3)
MOST_CELLS = 2**24  # of an array: 4096 x 4096
SKEW = 1e-6 + 1e-5 * EYE  # how far products of an array's axes may be from 0 and 1


def distances(
    mesh: Mesh | Surface,
    vertices: ArrayLike,
    cells: tuple[int, int] = (16, 16),
    pitch: float = 0.01,
    max_distance: float | None = None,
    axes: np.ndarray | None = None,
    contact: str = "tangent",
) -> np.ndarray:
    """(k, rows, cols) f8: distance of each cell to the surface along the normal, in units of the mesh.

    The array is a plane grid of rows x cols cells, `pitch` units apart, centred on the vertex, its normal the average
    of the unit normals of the faces around (`sensor_normals`). Row 0 is at the top and column 0 at the left, seen
    from outside onto the object (`sensor_axes`).

    A distance is positive where the surface lies below the array, zero at contact and negative where the cell is inside
    the object: then it is minus the distance to the surface along +normal (T4.3.1). A cell is inside when the first
    face below and the first face above are both seen from their back. Where only the one below is (an open mesh, mixed
    orientation), the surface below counts. In a sheet, such as the surface that a depth camera sees, a cell with
    nothing below is inside where the face above is seen from its back (`Surface.is_sheet`). Of two faces at one height,
    where parts of the object touch, the one seen from its back counts. If both numbers of cells are odd, the middle
    cell is the vertex itself, 0. A cell without a surface within `max_distance`, the sensing depth in both directions,
    reports `max_distance`. By default that is the longer side of the array.

    The thesis uses the centre of the face that the ray hits as the surface point (T figure 4.7). Here it is the exact
    intersection, so that the imprint does not depend on the triangulation.

    Warns of vertices where no cell finds a surface.

    mesh: a Mesh, or a Surface if it is touched more than once; vertices: (k,) vertex ids; axes: (k, 3, 3) rows
    right, up, normal, to orient the array otherwise; contact: "tangent" (the plane stands at the vertex) or "rigid"
    (it rests on the first contact), see `haptic_glance.touch.distances`.
    Raises ValueError for invalid cells or pitch, and one that names a vertex that cannot be touched.
    """
    surface = as_surface(mesh)
    vertices = check_vertices(surface.mesh, vertices)
    (rows, columns), pitch, max_distance = check_array(cells, pitch, max_distance)
    axes = sensor_axes(sensor_normals(surface.mesh, vertices), surface.mesh.up) if axes is None else axes
    cell_distances = distances_at(
        surface, surface.mesh.vertices[vertices], axes, (rows, columns), pitch, max_distance, contact
    )
    missed = vertices[(cell_distances == max_distance).all(axis=(1, 2))]
    if len(missed):
        rest_text = f" and {len(missed) - 1} others" if len(missed) > 1 else ""
        warn_caller(
            f"the array touches nothing at vertex {missed[0]}{rest_text}: the faces there look inwards "
            "(`haptic_glance.repair` turns them), or the place is narrower than a cell"
        )
    if contact == "tangent" and rows % 2 and columns % 2:
        cell_distances[:, rows // 2, columns // 2] = 0.0
    return cell_distances


def distances_at(
    surface: Mesh | Surface,
    centres: ArrayLike,
    axes: ArrayLike,
    cells: tuple[int, int] = (16, 16),
    pitch: ArrayLike = 0.01,
    max_distance: ArrayLike | None = None,
    contact: str = "tangent",
) -> np.ndarray:
    """(k, rows, cols) f8: `distances` of arrays anywhere: centres (k, 3) and axes (k, 3, 3) rows right, up, normal.

    pitch: a number, or (k,), one per array; max_distance: the same, by default the longer side of each array.
    `snap_to_surface` finds positions on the surface.
    """
    surface = as_surface(surface)
    centres, axes = check_places(centres, axes)
    cells, pitches, max_distances = check_arrays(cells, pitch, max_distance, len(centres))
    return contact_distances(surface, centres, axes, cells, pitches, max_distances, contact)


def as_places(centres: ArrayLike, axes: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """The centres (k, 3) and axes (k, 3, 3) of arrays as f8; raises ValueError if their shapes are invalid."""
    centres, axes = np.asarray(centres, dtype=np.float64), np.asarray(axes, dtype=np.float64)
    if centres.ndim != 2 or centres.shape[1] != 3:
        raise ValueError(f"centres must be finite and of shape (k, 3), got shape {centres.shape}")
    if axes.shape != (len(centres), 3, 3):
        raise ValueError(f"axes must have shape ({len(centres)}, 3, 3), one frame per array, got {axes.shape}")
    return centres, axes


def check_places(centres: ArrayLike, axes: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """As `as_places`; raises ValueError if they are invalid."""
    centres, axes = as_places(centres, axes)
    if not np.isfinite(centres).all():
        raise ValueError(f"centres must be finite, got {centres[~np.isfinite(centres).all(axis=1)][0]}")
    # Right-handed, or front and back of every face would be exchanged.
    skew = np.abs(axes @ axes.transpose(0, 2, 1) - EYE)
    if not (skew <= SKEW).all() or (np.linalg.det(axes) < 0).any():
        raise ValueError("axes must be three perpendicular unit vectors per array: right, up, normal = right x up")
    return centres, axes


def check_array(
    cells: Sequence[int], pitch: float, max_distance: float | None = None
) -> tuple[tuple[int, int], float, float]:
    """((rows, columns), pitch, max_distance) as numbers; raises ValueError if they are invalid."""
    cells, pitch = _check_cells(cells), _length("pitch", pitch)
    return cells, pitch, max(cells) * pitch if max_distance is None else _length("max_distance", max_distance)


def check_arrays(
    cells: Sequence[int], pitch: ArrayLike, max_distance: ArrayLike | None, count: int
) -> tuple[tuple[int, int], np.ndarray, np.ndarray]:
    """((rows, columns), pitches (count,), max_distances (count,)); raises ValueError if they are invalid."""
    cells, pitches = _check_cells(cells), _lengths("pitch", pitch, count)
    return (
        cells,
        pitches,
        max(cells) * pitches if max_distance is None else _lengths("max_distance", max_distance, count),
    )


def _check_cells(cells):
    plain = type(cells) is tuple and [*map(type, cells)] == [int, int] and min(cells) >= 1  # nearly always
    if not plain and (
        np.shape(cells) != (2,)
        or np.asarray(cells).dtype.kind not in "iuf"
        or any(not number >= 1 or number % 1 for number in cells)
    ):
        raise ValueError(f"cells must be two whole numbers from 1 (rows, columns), got {cells}")
    if cells[0] * cells[1] > MOST_CELLS:
        raise ValueError(f"cells={tuple(cells)}: an array has at most {MOST_CELLS:,} cells")
    return int(cells[0]), int(cells[1])


def _length(name, value):
    if isinstance(value, int | float) and 0 < value < np.inf:  # nearly always, in a tenth of the time of arrays
        return float(value)
    return float(_lengths(name, value, 1)[0])


def _lengths(name, values, count):
    values = np.asarray(values, dtype=np.float64)
    if values.shape not in ((), (count,)):
        raise ValueError(f"{name} must be a number or have shape ({count},), one per array, got {values.shape}")
    valid = (values > 0) & (values < np.inf)
    if not valid.all():
        raise ValueError(f"{name} must be a positive number of units, got {values[~valid].flat[0]}")
    return np.full(count, values)


CONTACTS = ("tangent", "rigid")


def contact_distances(
    surface: Surface,
    centres: np.ndarray,
    axes: np.ndarray,
    cells: tuple[int, int],
    pitches: np.ndarray,
    max_distances: np.ndarray,
    contact: str,
) -> np.ndarray:
    """(k, rows, cols) distances of the arrays from their position, limited to `max_distances`.

    rigid: the plane starts `max_distance` above the place and moves down along its normal until the column of one of
    its cells, or the place itself, touches the object. Distances count from there, 0 to `max_distance`. Where a cell is
    inside the object at the start (in a cup narrower than the array and deeper than `max_distance`), the array cannot
    enter. It stays at the start, such cells touch (0) and the others measure from there. Where the array touches
    nothing, every cell reports `max_distance`.

    After `normalise` both are equal as long as one surface covers the array's footprint, since both are shifted by the
    least distance. They differ where something overhangs the place (a handle, a rim, the far side of a fold): the
    tangent plane is below it or intersects it and does not measure it, a rigid one rests on it. They also differ in the
    depth limit, which for a rigid array counts from where it rests.
    """
    if contact not in CONTACTS:
        raise ValueError(f"contact must be one of {', '.join(CONTACTS)}, got {contact!r}")
    limit = max_distances[:, None, None]
    if contact == "tangent":
        distances = surface.measure(centres, axes, cells, pitches)
        return np.clip(distances, -limit, limit, out=distances)
    distances = surface.measure(centres + max_distances[:, None] * axes[:, 2], axes, cells, pitches)
    np.maximum(distances, 0.0, out=distances)
    distances -= np.minimum(distances.min(axis=(1, 2), keepdims=True), limit)
    return np.minimum(distances, limit, out=distances)


MIN_PITCH = 0.2  # of the pitch, as T4.3.2's fine sensor (0.002) to its coarse one (0.01)
MAX_FACTOR = 0.99  # between the pitches of two measurements, at most
TOLERANCE = 0.5  # of the pitch: how deep a cell may be inside the object, as an elastic skin yields


def adaptive_distances(
    surface: Mesh | Surface,
    centres: ArrayLike,
    axes: ArrayLike,
    cells: tuple[int, int] = (32, 32),
    pitch: ArrayLike = 0.01,
) -> tuple[np.ndarray, np.ndarray]:
    """The pitches (k,), at most `pitch`, at which arrays fit on the object (T4.4.3), and their distances.

    The arrays are at centres (k, 3) with axes (k, 3, 3); the distances (k, rows, cols) are those of `distances_at`. An
    array fits when no cell is more than half a pitch inside the object. If it does not fit, its pitch shrinks
    to the size at which the deepest cells of two neighbouring square rings predict a fit, and it is measured again.
    This ends when the array fits or the pitch is a fifth of `pitch`, which is returned even if it does not fit. The
    thesis shrinks the array and gives no rule. pitch: a number, or (k,). Raises ValueError for invalid cells or
    pitches.
    """
    centres, axes = np.asarray(centres, dtype=np.float64), np.asarray(axes, dtype=np.float64)
    cells, pitches, max_distances = check_arrays(cells, pitch, None, len(centres))
    min_pitches, tolerances = MIN_PITCH * pitches, TOLERANCE * pitches
    pitches, active = pitches.copy(), np.arange(len(centres))
    distances = np.empty((len(centres), *cells))
    widths, ring = _rings(cells)
    by_ring, starts = np.argsort(ring, kind="stable"), np.searchsorted(np.sort(ring), np.arange(len(widths)))
    while len(active):
        places = centres[active], axes[active], cells, pitches[active], max_distances[active]
        distances[active] = distances_at(surface, *places)
        active = active[pitches[active] > min_pitches[active]]
        by_cell = distances[active].reshape(len(active), len(ring))[:, by_ring] + tolerances[active, None]
        clearance = np.minimum.reduceat(by_cell, starts, axis=1)
        too_large = (clearance < 0).any(axis=1)
        active, clearance = active[too_large], clearance[too_large]
        pitches[active] = np.maximum(pitches[active] * _fitting_widths(widths, clearance), min_pitches[active])
    limits = check_arrays(cells, pitches, None, len(centres))[2][:, None, None]  # a smaller array senses less deep
    return pitches, np.clip(distances, -limits, limits)


def _rings(cells):
    """(half widths of the square rings of cells, the outermost 1; the ring of each cell (rows * cols,))."""
    rows, columns = (np.abs(np.arange(count) - (count - 1) / 2) / (max(count - 1, 1) / 2) for count in cells)
    widths, ring = np.unique(np.maximum(rows[:, None], columns).round(12), return_inverse=True)
    return widths, ring.ravel()


def _fitting_widths(widths, clearance):
    """(k,) half widths at which the clearance (k, rings) becomes 0, interpolated between two rings."""
    first = np.argmax(clearance < 0, axis=1)
    rows, inner = np.arange(len(clearance)), np.maximum(first - 1, 0)
    margin = np.where(first > 0, clearance[rows, inner], 0.0)
    share = margin / (margin - clearance[rows, first])
    start = np.where(first > 0, widths[inner], 0.0)
    return np.minimum(start + share * (widths[first] - start), MAX_FACTOR)
