"""The raw measurement of the virtual pressure array: the distance from each cell to the surface (T4.3.1)."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from stages.kit import Mesh
from stages.kit.sensor_axes import sensor_axes

from .contact import contact_distances
from .frame import check_vertices, sensor_normals
from .surface import Surface, as_surface


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
    orientation), the surface below counts. Of two faces at one height, where parts of the object touch, the one seen
    from its back counts. If both numbers of cells are odd, the middle cell is the vertex itself, 0. A cell without a
    surface within `max_distance`, the sensing depth in both directions, reports `max_distance`. By default that is the
    longer side of the array.

    The thesis uses the centre of the face that the ray hits as the surface point (T figure 4.7). Here it is the exact
    intersection, so that the imprint does not depend on the triangulation.

    mesh: a Mesh, or a Surface if it is touched more than once; vertices: (k,) vertex ids; axes: (k, 3, 3) rows
    right, up, normal, to orient the array otherwise; contact: "tangent" (the plane stands at the vertex) or "rigid"
    (it rests on the first contact), see `stages.imprints.contact`.
    Raises ValueError for invalid cells or pitch, and one that names a vertex that cannot be touched.
    """
    surface = as_surface(mesh)
    vertices = check_vertices(surface.mesh, vertices)
    (rows, columns), pitch, max_distance = check_array(cells, pitch, max_distance)
    axes = sensor_axes(sensor_normals(surface.mesh, vertices), surface.mesh.up) if axes is None else axes
    measured = distances_at(
        surface, surface.mesh.vertices[vertices], axes, (rows, columns), pitch, max_distance, contact
    )
    if contact == "tangent" and rows % 2 and columns % 2:
        measured[:, rows // 2, columns // 2] = 0.0
    return measured


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


def check_places(centres: ArrayLike, axes: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """The centres (k, 3) and axes (k, 3, 3) of arrays as f8; raises ValueError if they are invalid."""
    centres, axes = np.asarray(centres, dtype=np.float64), np.asarray(axes, dtype=np.float64)
    if centres.ndim != 2 or centres.shape[1] != 3 or not np.isfinite(centres).all():
        raise ValueError(f"centres must be finite and of shape (k, 3), got shape {centres.shape}")
    if axes.shape != (len(centres), 3, 3):
        raise ValueError(f"axes must have shape ({len(centres)}, 3, 3), one frame per array, got {axes.shape}")
    # Right-handed, or front and back of every face would be exchanged.
    if not np.allclose(axes @ axes.transpose(0, 2, 1), np.eye(3), atol=1e-6) or (np.linalg.det(axes) < 0).any():
        raise ValueError("axes must be three perpendicular unit vectors per array: right, up, normal = right x up")
    return centres, axes


def check_array(
    cells: Sequence[int], pitch: float, max_distance: float | None = None
) -> tuple[tuple[int, int], float, float]:
    """((rows, columns), pitch, max_distance) as numbers; raises ValueError if they are invalid."""
    cells, pitches, max_distances = check_arrays(cells, pitch, max_distance, 1)
    return cells, float(pitches[0]), float(max_distances[0])


def check_arrays(
    cells: Sequence[int], pitch: ArrayLike, max_distance: ArrayLike | None, count: int
) -> tuple[tuple[int, int], np.ndarray, np.ndarray]:
    """((rows, columns), pitches (count,), max_distances (count,)); raises ValueError if they are invalid."""
    if np.shape(cells) != (2,) or any(not number >= 1 or number % 1 for number in cells):
        raise ValueError(f"cells must be two whole numbers from 1 (rows, columns), got {cells}")
    rows, columns = (int(number) for number in cells)
    pitches = _lengths("pitch", pitch, count)
    max_distances = (
        max(rows, columns) * pitches if max_distance is None else _lengths("max_distance", max_distance, count)
    )
    return (rows, columns), pitches, max_distances


def _lengths(name, values, count):
    values = np.asarray(values, dtype=np.float64)
    if values.shape not in ((), (count,)):
        raise ValueError(f"{name} must be a number or have shape ({count},), one per array, got {values.shape}")
    invalid = values[~(np.isfinite(values) & (values > 0))]
    if invalid.size:
        raise ValueError(f"{name} must be a positive number of units, got {invalid.flat[0]}")
    return np.broadcast_to(values, (count,))
