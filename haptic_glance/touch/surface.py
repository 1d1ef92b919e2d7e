"""A mesh prepared for touching, the normal of the array's plane, and the directions of the array's rows and columns."""

import math
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.base.warner import warn_caller
from haptic_glance.mesh.axes import Axis, axis_named, to_z_up
from haptic_glance.mesh.files import MeshLike, with_known_up
from haptic_glance.mesh.materials import merge_equal_rows
from haptic_glance.mesh.mesh import Mesh, corner_sum, unit

from .kernels.faces import face_tree
from .kernels.measure import FIRST_BELOW, MEASURE, PRESS

FLAT = 1e-9  # of the cubed diagonal: a smaller volume is rounding
SHEET = 0.1  # of the area; the open meshes of the data sets, with holes and gaps, have at most 0.08
LIFT = 1e-6  # of the mesh's diagonal: a face within this distance of the plane is at it; 16 steps in f4


class Surface:
    """A mesh prepared for touching: its faces in a tree of boxes (20 ms for 50,000 faces).

    Use a Surface to touch a mesh many times. Building one costs less than sending it to another process.

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The mesh, which must not change afterwards. Faces without area are ignored.

    Warns
    -----
    UserWarning
        For a closed mesh whose faces look inwards: the array would be inside, and miss the surface. If nothing says
        which axis points up.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import Mesh, Surface, press
    >>> ball = trimesh.creation.icosphere(3, radius=0.5)
    >>> surface = Surface(Mesh(ball.vertices, ball.faces))
    >>> [press(surface, vertex).shape for vertex in (0, 1)]
    [(16, 16), (16, 16)]
    """

    def __init__(self, mesh: MeshLike) -> None:
        self.mesh = mesh = with_known_up(mesh)
        if _inside_out(mesh):
            warn_caller(
                "the faces of the closed mesh look inwards, so that an array misses its surface: "
                "`haptic_glance.repair` turns them outwards"
            )
        solid = mesh.face_areas > 0
        self._tree = face_tree(mesh.vertices[mesh.faces[solid]], 2 * mesh.face_areas[solid])

    def measure(self, centres: np.ndarray, axes: np.ndarray, cells: tuple[int, int], pitches: np.ndarray) -> np.ndarray:
        """(k, rows, cols) signed distances of the cells of arrays, inf where missed. `distances` checks the arguments.

        centres (k, 3), axes (k, 3, 3), pitches (k,), all f8. The result for an array does not depend on the others.
        """
        return self._run(MEASURE, centres, axes, cells, np.array(pitches), self.is_sheet)

    @cached_property
    def is_sheet(self) -> bool:
        """Whether the surface is open over a large side, as a depth camera's: its area vectors do not cancel.

        Their sum is 0 for a closed surface, half of the area for half a ball, and all of it for a plane.
        """
        areas = self.mesh.face_areas
        return bool(np.linalg.norm(areas @ self.mesh.face_normals) > SHEET * areas.sum())

    def first_below(
        self, centres: np.ndarray, axes: np.ndarray, cells: tuple[int, int], pitches: np.ndarray, window: float
    ) -> np.ndarray:
        """(k, rows, cols) distances of the cells to the first surface below, of either side of a face.

        inf where there is none, or where it is more than `window` units below the nearest of its array. Arguments as of
        `measure`, of which this takes a fraction of the time.
        """
        return self._run(FIRST_BELOW, centres, axes, cells, np.array(pitches), window)

    def press(
        self,
        centres: np.ndarray,
        axes: np.ndarray,
        cells: tuple[int, int],
        pitch: float,
        unit: float,
        stiffness: float,
        limit: float,
        loads: np.ndarray,
        depths: np.ndarray,
    ) -> np.ndarray:
        """(k, rows, cols) newtons on the cells of arrays, see `kernels.measure.press`; `press_forces` checks."""
        return self._run(PRESS, centres, axes, cells, pitch, unit, stiffness, limit, loads, depths)

    def _run(self, kernel, centres, axes, cells, *more):
        # Copied, hence writeable: for a read-only array numba would compile everything again.
        places = np.array(centres, np.float64, order="C"), np.array(axes, np.float64, order="C")
        run = kernel.for_work(len(centres) * math.prod(cells))
        return run(*self._tree, self.mesh.diagonal, LIFT * self.mesh.diagonal, cells, *places, *more)


def _inside_out(mesh):
    """Whether the mesh is closed and its volume negative; the volume alone takes a fraction of the time."""
    if not len(mesh.faces):
        return False
    corners = mesh.vertices[mesh.faces] - mesh.vertices[mesh.faces[0, 0]]
    with np.errstate(over="ignore", invalid="ignore"):  # of huge coordinates
        six_volumes = np.einsum("ij,ij->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
        return six_volumes < -FLAT * mesh.diagonal**3 and mesh.watertight


_cached_surface = lru_cache(maxsize=2)(Surface)  # for touching one mesh, or two in turn, point by point


def as_surface(mesh: Mesh | Surface) -> Surface:
    """The Surface of a Mesh, cached; a Surface is returned as it is."""
    return mesh if isinstance(mesh, Surface) else _cached_surface(mesh)


ROUNDED = 1e-6  # from 1, of the length of a unit normal
CANCELLED = 1e-6  # length below which an average of unit normals is rounding error


def sensor_normals(mesh: Mesh, vertices: ArrayLike) -> np.ndarray:
    """Unit normals of the array's plane at vertices: the average of the unit normals of the faces around.

    Parameters
    ----------
    mesh : Mesh or any input of `as_mesh`
        The object.
    vertices : (k,) array_like of int
        Vertex ids.

    Returns
    -------
    (k, 3) array of float
        Unit normals. Every face around the vertex has the same weight, as in T4.3.1. Weights by area
        (`Mesh.vertex_normals`) or by angle tilt the plane where the faces differ in size. Faces without area have no
        normal and do not count.

    Raises
    ------
    ValueError
        For a vertex that is not in the mesh, is in no face, or whose faces cancel out. The message names the first.

    Examples
    --------
    >>> import trimesh
    >>> from haptic_glance import sensor_normals
    >>> sensor_normals(trimesh.creation.icosphere(2), [0]).shape
    (1, 3)
    """
    vertices = check_vertices(mesh, vertices)
    average = mean_vertex_normals(mesh)[vertices]
    bad = np.flatnonzero(np.linalg.norm(average, axis=1) <= CANCELLED)
    if len(bad):
        raise ValueError(
            f"vertex {vertices[bad[0]]} has no normal: it is in no face with area, or its faces cancel out; "
            "leave it out (haptic_glance.touch.touchable tells which vertices can be touched)"
        )
    return unit(average)


def touchable(mesh: Mesh, vertices: ArrayLike) -> np.ndarray:
    """(k,) boolean: the vertices (k,) at which the array has a normal, so that it can be pressed on the object."""
    return np.linalg.norm(mean_vertex_normals(mesh)[check_vertices(mesh, vertices)], axis=1) > CANCELLED


def check_vertices(mesh: Mesh, vertices: ArrayLike) -> np.ndarray:
    """The vertex ids as (k,) i8; raises ValueError if they are not integers or not in the mesh."""
    vertices = np.asarray(vertices)
    if vertices.ndim != 1:
        raise ValueError(f"vertices must have shape (k,), got {vertices.shape}")
    if vertices.size and not np.issubdtype(vertices.dtype, np.integer):
        raise ValueError(f"vertices must be whole numbers (vertex ids), got {vertices.dtype}")
    vertices = vertices.astype(np.int64)
    outside = vertices[(vertices < 0) | (vertices >= len(mesh.vertices))]
    if len(outside):
        raise ValueError(f"vertex {outside[0]} is not in the mesh: its vertices are 0..{len(mesh.vertices) - 1}")
    return vertices


@lru_cache(maxsize=4)  # used at every touch
def mean_vertex_normals(mesh: Mesh) -> np.ndarray:
    """(n, 3) means of the unit normals of the faces around each vertex; zero at a vertex in no face.

    Vertices at one place share their faces: a mesh may be split there for its colours, or be a soup of triangles. A
    vertex that looks the other way keeps its own faces, as on the two sides of a sheet.
    """
    solid = mesh.face_areas > 0
    total = corner_sum(mesh, np.repeat(mesh.face_normals[:, None], 3, axis=1))
    count = corner_sum(mesh, np.repeat(solid[:, None], 3, axis=1))
    used = np.flatnonzero(count)  # a vertex in no face keeps none
    x, y, z = mesh.vertices[used].T
    places = np.sort(x + np.sqrt(2) * y + np.sqrt(3) * z)  # equal at one place: a quick test for meshes without any
    if (places[1:] == places[:-1]).any():
        _, ids = merge_equal_rows(mesh.vertices[used])
        shared = np.stack([np.bincount(ids, column) for column in total[used].T], axis=1)[ids]
        agrees = np.einsum("ij,ij->i", shared, total[used]) > CANCELLED
        total[used[agrees]], count[used[agrees]] = shared[agrees], np.bincount(ids, count[used])[ids][agrees]
    return total / np.maximum(count, 1)[:, None]


POLE = 0.95  # |z| of a normal above which +z has no stable projection on the plane: within 18 degrees of the pole


def sensor_axes(normals: ArrayLike, up: Axis = "z") -> np.ndarray:
    """Axes of arrays with given normals, upright on the object.

    Parameters
    ----------
    normals : (k, 3) array_like
        Normals, of any length.
    up : str or (3,) array_like
        The axis of the object that points up, a name or a vector.

    Returns
    -------
    (k, 3, 3) array of float
        Rows right, up and normal, seen from outside onto the object.

    Notes
    -----
    Up is the object's axis projected on the plane, so that the array is upright everywhere. Within 18 degrees of the
    poles, where that has no stable direction, +y of an object that is z up is projected. The thesis does not give the
    array's rotation about its normal. The axes depend on the normal alone, not on the order of vertices or faces.

    Examples
    --------
    >>> from haptic_glance import sensor_axes
    >>> sensor_axes([[1, 0, 0]])[0].round(6).tolist()  # right, up, normal
    [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    """
    normals = np.asarray(normals, dtype=np.float64)
    if normals.ndim != 2 or normals.shape[1] != 3:
        raise ValueError(f"normals must have shape (k, 3), got {normals.shape}")
    if len(wrong := np.flatnonzero(~(np.isfinite(normals).all(axis=1) & normals.any(axis=1)))):
        raise ValueError(f"normals must be finite and not zero, got {normals[wrong[0]]} at place {wrong[0]}")
    largest = np.abs(normals).max(axis=1, keepdims=True, initial=0)
    normals = np.where((largest < 1e-100) | (largest > 1e100), normals / largest, normals)  # their squares round to 0
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.where(np.abs(lengths - 1) > ROUNDED, normals / lengths, normals)
    if (axis := axis_named(up)) != "z":
        return sensor_axes(normals @ to_z_up(axis).T) @ to_z_up(axis)
    polar = np.abs(normals[:, 2:]) > POLE
    towards = np.where(polar, [[0.0, 1.0, 0.0]], [[0.0, 0.0, 1.0]])
    upwards = unit(towards - np.sum(towards * normals, axis=1, keepdims=True) * normals)
    return np.stack([np.cross(upwards, normals), upwards, normals], axis=1)


def turned(axes: np.ndarray, degrees: float | np.ndarray) -> np.ndarray:
    """Axes (k, 3, 3) turned about their normals by degrees, one number or (k,), counter-clockwise from outside."""
    angles = np.broadcast_to(np.radians(degrees), len(axes))[:, None]
    cos, sin, (right, up, normal) = np.cos(angles), np.sin(angles), axes.swapaxes(0, 1)
    return np.stack([cos * right + sin * up, cos * up - sin * right, normal], axis=1)
