"""The raw measurement of the virtual pressure array: how far the surface is from each cell (T4.3.1)."""

import numpy as np

from stages.kit import Mesh, RayScene

from .frame import check_vertices, sensor_axes, sensor_normals

LIFT = (
    1e-6  # of the mesh's diagonal: a surface in the array's plane is met from just off it; 16 steps of single precision
)
BATCH = 1 << 16  # rays cast at once: their arrays then stay in the processor's cache


def distances(mesh, vertices, cells=(16, 16), pitch=0.01, reach=None, axes=None):
    """(k, rows, cols) f8: distance of each cell to the surface along the normal, in units of the mesh.

    The array is a plane grid of rows x cols cells, `pitch` units apart, centred on the vertex, its normal the average
    of the unit normals of the faces around (`sensor_normals`). Row 0 is at the top and column 0 at the left, seen
    from outside onto the object (`sensor_axes`).

    A distance is positive where the surface lies below the array (away from it, into the object), zero at contact and
    negative where the cell is inside the object: then it is the way out along +normal (T4.3.1). A cell is inside when
    the first face below and the first face above are both seen from their back; where only the one below is (an open
    mesh, mixed orientation), it is the surface below that counts. Where both counts of cells are odd the middle cell
    is the vertex itself, 0. A cell that finds no surface within `reach` reports the reach: the depth that the sensor
    can feel, both ways; by default the longer side of the array.

    The thesis takes the centre of the face that the ray meets for the surface point (T figure 4.7); here it is the
    exact crossing, so that the imprint does not change with the triangulation.

    vertices: (k,) vertex ids; axes: (k, 3, 3) rows right, up, normal, to turn the array by hand.
    Raises ValueError for cells or a pitch that make no array, and naming the vertex that cannot be touched.
    """
    vertices = check_vertices(mesh, vertices)
    (rows, columns), pitch, reach = check_sensor(cells, pitch, reach)
    axes = sensor_axes(sensor_normals(mesh, vertices)) if axes is None else _check_axes(axes, len(vertices))
    if len(vertices) == 0:
        return np.zeros((0, rows, columns))
    # Centred, so that embree's single precision is spent on the object and not on its place in the world.
    middle = (mesh.vertices.min(axis=0) + mesh.vertices.max(axis=0)) / 2
    local = Mesh(mesh.vertices - middle, mesh.faces)
    scene, lift = RayScene(local), LIFT * mesh.diagonal
    step = max(1, BATCH // (rows * columns))
    found = np.concatenate(
        [
            _measure(scene, local.vertices[vertices[i : i + step]], axes[i : i + step], (rows, columns), pitch, lift)
            for i in range(0, len(vertices), step)
        ]
    )
    if rows % 2 and columns % 2:
        found[:, rows // 2, columns // 2] = 0.0
    return np.clip(found, -reach, reach, out=found)


def _measure(scene, centres, axes, cells, pitch, lift):
    """(k, rows, cols) signed distances, inf where missed, of arrays centred at (k, 3) with axes (k, 3, 3)."""
    rows, columns = cells
    right, up, normal = axes.transpose(1, 0, 2)[:, :, None, None]
    down_rows = (((rows - 1) / 2 - np.arange(rows)) * pitch)[:, None, None]
    along_columns = ((np.arange(columns) - (columns - 1) / 2) * pitch)[None, :, None]
    points = (centres[:, None, None] + down_rows * up + along_columns * right).reshape(-1, 3)
    normals = np.broadcast_to(normal, (len(centres), rows, columns, 3)).reshape(-1, 3)

    below, from_back = _cast(scene, points + lift * normals, -normals)
    distance = below - lift
    maybe = np.flatnonzero(from_back)
    above, out_of_object = _cast(scene, points[maybe] - lift * normals[maybe], normals[maybe])
    distance[maybe[out_of_object]] = lift - above[out_of_object]
    return distance.reshape(len(centres), rows, columns)


def _cast(scene, origins, directions):
    """(distance (k,), inf where missed; from_back (k,): the face that was met is seen from its back)."""
    hits = scene.cast(origins, directions)
    facing = np.einsum("ij,ij->i", scene.mesh.face_crosses[hits.face], directions)  # face -1 is masked by `hit`
    return hits.distance, hits.hit & (facing > 0)


def check_sensor(cells, pitch, reach=None):
    """((rows, columns), pitch, reach) as numbers; ValueError where they make no array."""
    cells = tuple(cells) if np.ndim(cells) == 1 else (cells,)
    if len(cells) != 2 or any(int(count) != count or count < 1 for count in cells):
        raise ValueError(f"cells must be two whole numbers from 1 (rows, columns), got {cells}")
    rows, columns = (int(count) for count in cells)
    reach = max(rows, columns) * pitch if reach is None else reach
    for name, value in (("pitch", pitch), ("reach", reach)):
        if not (np.isfinite(value) and value > 0):
            raise ValueError(f"{name} must be a positive number of units, got {value}")
    return (rows, columns), float(pitch), float(reach)


def _check_axes(axes, count):
    axes = np.asarray(axes, dtype=np.float64)
    if axes.shape != (count, 3, 3):
        raise ValueError(f"axes must have shape ({count}, 3, 3), one frame a vertex, got {axes.shape}")
    if not np.allclose(axes @ axes.transpose(0, 2, 1), np.eye(3), atol=1e-6):
        raise ValueError("axes must be three perpendicular unit vectors a vertex: right, up, normal")
    return axes
