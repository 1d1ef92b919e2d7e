"""Imprints: the distances of the array as images in 0..1; and a warm-up before time is measured."""

import functools

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.mesh.mesh import Mesh

from .distances import check_arrays, distances, distances_at
from .kernels.faces import ORDER
from .kernels.measure import FIRST_BELOW, MEASURE, PRESS
from .surface import Surface

FLAT = 1e-3  # of the pitch: relief below it is rounding of the mesh's coordinates
FAINT = 0.1  # of the pitch: a relief below has less contrast in pictures
BLOCK = 1 << 20  # cells scaled at once, 8 MB in double precision


def press(
    mesh: Mesh | Surface,
    vertex: int,
    cells: tuple[int, int] = (16, 16),
    pitch: float = 0.01,
    max_distance: float | None = None,
    contact: str = "tangent",
) -> np.ndarray:
    """The imprint of the virtual pressure array pressed on a mesh at one vertex (T4.3.1).

    Parameters
    ----------
    mesh : Mesh, Surface or any input of `as_mesh`
        The object; a Surface if it is touched more than once.
    vertex : int
        Vertex id. The plane of the array is perpendicular to the average of the normals of the faces around it
        (`sensor_normals`). Row 0 is at the top and column 0 at the left, seen from outside onto the object
        (`sensor_axes`).
    cells : tuple of 2 ints
        Rows and columns.
    pitch : float or str
        Distance of neighbouring cells, in units of the mesh. `haptic_glance.press` takes a share of the object's
        diameter, or a text such as "1mm" together with `unit`, the unit of the mesh's coordinates.
    max_distance : float or str, optional
        Sensing depth in both directions; a cell without a surface within it reports it. None: the longer side of the
        array.
    contact : {"tangent", "rigid"}
        `tangent`: the plane stands at the vertex. `rigid`: it rests on the first contact.

    Returns
    -------
    (rows, cols) array of float
        0 at the cell of first contact, 1 at the cell farthest from the surface. So the image shows distance and is dark
        where the pressure is high; 1 - image is the pressure. A flat place gives all zeros, and so does an array that
        misses the object with every cell.

    Raises
    ------
    ValueError
        For invalid cells or pitch, and for a vertex that cannot be touched, which the message names.

    Warns
    -----
    UserWarning
        If no cell finds a surface.

    Notes
    -----
    The thesis uses the centre of the face that the ray hits as the surface point (T figure 4.7). Here it is the exact
    intersection, so that the imprint does not depend on the triangulation.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import Mesh, press
    >>> ball = trimesh.creation.icosphere(4, radius=0.5)
    >>> image = press(Mesh(ball.vertices, ball.faces), 0, cells=(8, 8), pitch=0.02)
    >>> image.shape, float(image.min()), float(image.max())
    ((8, 8), 0.0, 1.0)
    """
    return press_many(mesh, [vertex], cells, pitch, max_distance, contact)[0]


def press_many(
    mesh: Mesh | Surface,
    vertices: ArrayLike,
    cells: tuple[int, int] = (16, 16),
    pitch: float = 0.01,
    max_distance: float | None = None,
    contact: str = "tangent",
) -> np.ndarray:
    """The imprints of the array at several vertices, as `press` makes them.

    Parameters
    ----------
    mesh : Mesh, Surface or any input of `as_mesh`
        The object.
    vertices : (k,) array_like of int
        Vertex ids.
    cells, pitch, max_distance, contact
        As of `press`.

    Returns
    -------
    (k, rows, cols) array of float
        Imprints in 0..1.

    Raises
    ------
    ValueError
        As `press` does.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import Mesh, press_many
    >>> ball = trimesh.creation.icosphere(3, radius=0.5)
    >>> press_many(Mesh(ball.vertices, ball.faces), [0, 5], cells=(8, 8)).shape
    (2, 8, 8)
    """
    return normalise(distances(mesh, vertices, cells, pitch, max_distance, contact=contact), pitch)


def press_at(
    surface: Mesh | Surface,
    centres: ArrayLike,
    axes: ArrayLike,
    cells: tuple[int, int] = (16, 16),
    pitch: ArrayLike = 0.01,
    max_distance: ArrayLike | None = None,
    contact: str = "tangent",
) -> np.ndarray:
    """(k, rows, cols) f4 in 0..1: the imprints of arrays at centres (k, 3) with axes (k, 3, 3), see `distances_at`."""
    return normalise(distances_at(surface, centres, axes, cells, pitch, max_distance, contact), pitch)


def as_shown(images: np.ndarray, reliefs: ArrayLike, pitch: float) -> np.ndarray:
    """Imprints (k, rows, cols) in 0..1 for a picture: a relief (k,) below a tenth of the pitch has less contrast.

    Scaled to the whole range, as recognition needs it, a flat place would look like a deep one.
    """
    contrast = np.minimum(np.asarray(reliefs, dtype=np.float64) / (FAINT * pitch), 1)
    return images * contrast[:, None, None]


def normalise(distances: ArrayLike, pitch: ArrayLike) -> np.ndarray:
    """Distances (k, rows, cols) scaled to 0..1, each imprint by its own least and greatest (T4.3.1): f4.

    pitch: a number, or (k,), one per imprint.

    The reason in the thesis: a rigid array touches first where the distance is most negative, and the shift makes this
    cell zero. An imprint with a relief below a thousandth of the pitch is flat: all zero, not amplified noise.
    """
    distances = np.asarray(distances)
    if distances.ndim != 3:
        raise ValueError(f"distances must have shape (k, rows, cols), got {distances.shape}")
    cells, pitches, _ = check_arrays(distances.shape[1:], pitch, None, len(distances))
    images, step = np.empty(distances.shape, dtype=np.float32), max(1, BLOCK // (cells[0] * cells[1]))
    for i in range(0, len(distances), step):
        above = distances[i : i + step].astype(np.float64)
        if not np.isfinite(above).all():
            raise ValueError("distances must be finite numbers of units")
        above -= above.min(axis=(1, 2), keepdims=True)
        relief = above.max(axis=(1, 2), keepdims=True)
        flat = relief <= FLAT * pitches[i : i + step, None, None]
        images[i : i + step] = above * np.divide(1.0, relief, out=np.zeros_like(relief), where=~flat)
    return images


@functools.cache
def warm_up() -> None:
    """Touches a tetrahedron, once in a process: before time is measured, this loads or compiles machine code."""
    for kernel in (ORDER, MEASURE, FIRST_BELOW, PRESS):
        kernel.compile_always()
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    press(Mesh(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])), 0)
