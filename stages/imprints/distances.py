"""The raw measurement of the virtual pressure array: how far the surface is from each cell (T4.3.1)."""

import numpy as np

from .contact import tangent_or_rigid
from .frame import check_vertices, sensor_axes, sensor_normals
from .surface import ready


def distances(mesh, vertices, cells=(16, 16), pitch=0.01, reach=None, axes=None, contact="tangent"):
    """(k, rows, cols) f8: distance of each cell to the surface along the normal, in units of the mesh.

    The array is a plane grid of rows x cols cells, `pitch` units apart, centred on the vertex, its normal the average
    of the unit normals of the faces around (`sensor_normals`). Row 0 is at the top and column 0 at the left, seen
    from outside onto the object (`sensor_axes`).

    A distance is positive where the surface lies below the array (away from it, into the object), zero at contact and
    negative where the cell is inside the object: then it is the way out along +normal (T4.3.1). A cell is inside when
    the first face below and the first face above are both seen from their back; where only the one below is (an open
    mesh, mixed orientation), it is the surface below that counts. Of two faces at one height, where parts of the object
    stand on each other, the one seen from its back counts. Where both counts of cells are odd the middle cell
    is the vertex itself, 0. A cell that finds no surface within `reach` reports the reach: the depth that the sensor
    can feel, both ways; by default the longer side of the array.

    The thesis takes the centre of the face that the ray meets for the surface point (T figure 4.7); here it is the
    exact crossing, so that the imprint does not change with the triangulation.

    mesh: a Mesh, or a Surface where it is touched more than once; vertices: (k,) vertex ids; axes: (k, 3, 3) rows
    right, up, normal, to turn the array by hand; contact: "tangent" (the plane stands at the vertex) or "rigid" (it
    rests on what it meets first), see `stages.imprints.contact`.
    Raises ValueError for cells or a pitch that make no array, and naming the vertex that cannot be touched.
    """
    surface = ready(mesh)
    vertices = check_vertices(surface.mesh, vertices)
    (rows, columns), pitch, reach = check_sensor(cells, pitch, reach)
    axes = sensor_axes(sensor_normals(surface.mesh, vertices)) if axes is None else axes
    found = distances_at(surface, surface.mesh.vertices[vertices], axes, (rows, columns), pitch, reach, contact)
    if contact == "tangent" and rows % 2 and columns % 2:
        found[:, rows // 2, columns // 2] = 0.0
    return found


def distances_at(surface, centres, axes, cells=(16, 16), pitch=0.01, reach=None, contact="tangent"):
    """(k, rows, cols) f8: `distances` of arrays anywhere: centres (k, 3) and axes (k, 3, 3) rows right, up, normal.

    pitch: a number, or (k,) one an array; reach: the same, by default the longer side of each array. `place` finds
    places on the surface.
    """
    surface = ready(surface)
    centres = np.asarray(centres, dtype=np.float64)
    if centres.ndim != 2 or centres.shape[1] != 3 or not np.isfinite(centres).all():
        raise ValueError(f"centres must be finite and of shape (k, 3), got shape {centres.shape}")
    axes = _check_axes(axes, len(centres))
    cells, pitches, reaches = check_sensors(cells, pitch, reach, len(centres))
    return tangent_or_rigid(surface, centres, axes, cells, pitches, reaches, contact)


def check_sensor(cells, pitch, reach=None):
    """((rows, columns), pitch, reach) as numbers; ValueError where they make no array."""
    cells, pitches, reaches = check_sensors(cells, pitch, reach, 1)
    return cells, float(pitches[0]), float(reaches[0])


def check_sensors(cells, pitch, reach, count):
    """((rows, columns), pitches (count,), reaches (count,)); ValueError where they make no array."""
    cells = tuple(cells) if np.ndim(cells) == 1 else (cells,)
    if len(cells) != 2 or any(not number >= 1 or number % 1 for number in cells):
        raise ValueError(f"cells must be two whole numbers from 1 (rows, columns), got {cells}")
    rows, columns = (int(number) for number in cells)
    pitches = _lengths("pitch", pitch, count)
    reaches = max(rows, columns) * pitches if reach is None else _lengths("reach", reach, count)
    return (rows, columns), pitches, reaches


def _lengths(name, values, count):
    values = np.asarray(values, dtype=np.float64)
    if values.shape not in ((), (count,)):
        raise ValueError(f"{name} must be a number or have shape ({count},), one an array, got {values.shape}")
    wrong = values[~(np.isfinite(values) & (values > 0))]
    if wrong.size:
        raise ValueError(f"{name} must be a positive number of units, got {wrong.flat[0]}")
    return np.broadcast_to(values, (count,))


def _check_axes(axes, count):
    axes = np.asarray(axes, dtype=np.float64)
    if axes.shape != (count, 3, 3):
        raise ValueError(f"axes must have shape ({count}, 3, 3), one frame an array, got {axes.shape}")
    # Right-handed, or front and back of every face would change places.
    if not np.allclose(axes @ axes.transpose(0, 2, 1), np.eye(3), atol=1e-6) or (np.linalg.det(axes) < 0).any():
        raise ValueError("axes must be three perpendicular unit vectors an array: right, up, normal = right x up")
    return axes
