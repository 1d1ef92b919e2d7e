"""The thesis's earlier sensor: imprints are contours where quasi-tangent planes intersect the object (T4.2.3.1)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.mesh.mesh import Mesh, unit

from .distances import CONTACTS, check_array, distances, distances_at
from .press import normalise
from .skin import Layer
from .surface import LIFT, Surface, as_surface, check_vertices, sensor_axes, sensor_normals, touchable

DEPTH = 0.25  # of the array's longer side: how far the elastic skin yields
PLANES = 16
COLLINEAR = 1e-3  # sine of the angle at the first neighbour, below which three neighbours span no plane


def contour_imprints(
    mesh: Mesh | Surface,
    vertices: ArrayLike,
    cells: tuple[int, int] = (16, 16),
    pitch: float = 0.01,
) -> np.ndarray:
    """(k, rows, cols) f4 in 0..1, steps of 1 / PLANES: imprints of the sensor of quasi-tangent planes (T4.2.3.1).

    The first plane contains the three neighbours closest to the vertex (T figure 4.2, `quasi_tangent`). The others
    follow inwards at equal steps, down to a quarter of the array's longer side. A cell's pressure is the share of
    planes at or below the first surface there. The image is 1 minus it, so that 0 is the highest pressure, as in
    `press`. A plane beyond the far side of a wall still counts: the thesis registers areas of intersection and does not
    say, but a skin does not pass through a wall, and a thin cup would otherwise show its thickness and not its shape.
    A plane that touches the surface counts. Array, axes and errors as in `distances` and `quasi_tangent`.
    """
    surface = as_surface(mesh)
    cells, pitch, side = check_array(cells, pitch)
    depth = DEPTH * side
    centres, axes = quasi_tangent(surface.mesh, vertices)
    below = distances_at(surface, centres, axes, cells, pitch, max_distance=2 * depth) - LIFT * surface.mesh.diagonal
    short = np.searchsorted(np.linspace(0, depth, PLANES), below)  # planes that end above the surface
    return (short / PLANES).astype(np.float32)


def quasi_tangent(mesh: Mesh, vertices: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """(centres (k, 3), axes (k, 3, 3)) of arrays on the planes through the three neighbours closest to each vertex.

    The plane's normal is the cross product of P1P2 and P1P3, with the sign of the average normal. The array's centre is
    the vertex's projection on the plane. Neighbours are vertices one edge away. If the three lie on a line, the next
    closest replaces the third, if need be one two edges away. Coincident vertices count as one.
    Raises ValueError that names a vertex around which no three neighbours span a plane, or that has no normal.
    """
    vertices = check_vertices(mesh, vertices)
    outward = sensor_normals(mesh, vertices)
    planes_found = [_plane(mesh, vertex) for vertex in vertices]
    if None in planes_found:
        raise ValueError(
            f"around vertex {vertices[planes_found.index(None)]} no three neighbours span a plane: there are fewer, or "
            "they are collinear; use `press`"
        )
    places, normals = np.array(planes_found).reshape(-1, 2, 3).swapaxes(0, 1)
    normals *= np.where(np.einsum("ij,ij->i", normals, outward) < 0, -1, 1)[:, None]
    points = mesh.vertices[vertices]
    centres = points + np.einsum("ij,ij->i", places - points, normals)[:, None] * normals
    return centres, sensor_axes(normals, mesh.up)


def spans_plane(mesh: Mesh, vertices: ArrayLike) -> np.ndarray:
    """(k,) boolean: the vertices (k,) that this sensor can touch: with a normal and neighbours that span a plane."""
    vertices = check_vertices(mesh, vertices)
    return touchable(mesh, vertices) & np.array([_plane(mesh, vertex) is not None for vertex in vertices], dtype=bool)


def _plane(mesh, vertex):
    """(a point (3,), unit normal (3,)) of the plane through the three closest neighbours that span one, or None."""
    links, point = mesh.adjacency, mesh.vertices[vertex]
    neighbours = links.indices[links.indptr[vertex] : links.indptr[vertex + 1]]
    for ids in (neighbours, np.unique(links[neighbours].indices)):
        offsets = mesh.vertices[ids] - point
        lengths = np.linalg.norm(offsets, axis=1)
        offsets = np.unique(np.c_[lengths, offsets][lengths > 0], axis=0)[:, 1:]  # closest first, each place once
        if len(offsets) < 3:
            continue
        crosses = np.cross(offsets[1] - offsets[0], offsets[2:] - offsets[0])
        sides = np.linalg.norm(offsets[1] - offsets[0]) * np.linalg.norm(offsets[2:] - offsets[0], axis=1)
        spanning = np.flatnonzero(np.linalg.norm(crosses, axis=1) > COLLINEAR * sides)
        if len(spanning):
            return point + offsets[0], unit(crosses[spanning[0]])
    return None


CONTOURS = "contours"
SENSORS = (*CONTACTS, CONTOURS)


@dataclass(frozen=True)
class Touched:
    """The touches of a sensor at k vertices.

    can: (k,) boolean, where it can touch, t times. depths: (t, rows, cols) f4 in units. images: the same in 0..1, 0
    pressed first. reach: the depth of a cell with no surface in range.
    """

    can: np.ndarray
    depths: np.ndarray
    images: np.ndarray
    reach: float


SMALL, LARGE = 1e-3, 2.0  # of the object: a smaller or larger array rather has another unit of length than the object


def misfit(cells: Sequence[int], pitch: float) -> str:
    """The fault of an array that is longer than the object, of diameter 1, or next to nothing beside it; else ""."""
    length, doubt = max(cells) * pitch, "is the unit of length right?"
    size = f"the array is {length:g} units long, the object 1"
    if length < SMALL:
        return f"{size}: it feels one point; {doubt}"
    wrong = f"{size}: most cells will miss it; take fewer or a smaller pitch"
    return "" if length <= 1 else f"{wrong}; {doubt}" if length > LARGE else wrong


def misfit_of_layer(layer: Layer, length: float, size: float) -> str:
    """The fault of a layer on an array, both far from the size of real sensors or of the object, in metres; else ""."""
    if layer.thickness > size:
        return f"the layer is {layer.thickness:g} m thick, more than the object, {size:.3g} m across"
    if layer.thickness < SMALL * length:
        return (
            f"the array is {length:.3g} m long under a layer of {layer.thickness:g} m, the object {size:.3g} m across"
        )
    return ""


def touch(surface: Surface, vertices: ArrayLike, cells: tuple[int, int], pitch: float, sensor: str) -> Touched:
    """Touches vertices (k,) with a sensor of SENSORS: `press`, or `contour_imprints` of the sensor of T4.2.3.1."""
    mesh, (_, _, reach) = surface.mesh, check_array(cells, pitch)
    vertices = np.asarray(vertices)
    if sensor == CONTOURS:
        is_touchable = spans_plane(mesh, vertices)
        images, reach = contour_imprints(surface, vertices[is_touchable], cells, pitch), DEPTH * max(cells) * pitch
        return Touched(is_touchable, images * reach, images, reach)
    is_touchable = touchable(mesh, vertices)
    depths = distances(surface, vertices[is_touchable], cells, pitch, contact=sensor)
    return Touched(is_touchable, depths, normalise(depths, pitch), reach)
