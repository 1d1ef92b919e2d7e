"""The older sensor of the thesis: contours where close quasi-tangent planes cut the object (T4.2.3.1)."""

import numpy as np

from stages.kit.mesh import unit

from .distances import check_sensor, distances_at
from .frame import check_vertices, sensor_axes, sensor_normals
from .surface import LIFT, ready

DEPTH = 0.25  # of the array's longer side: the elastic skin of a pressure array gives way by a part of its width
IN_LINE = 1e-3  # sine of the angle at the first neighbour, below which three neighbours span no plane


def contour_imprints(mesh, vertices, cells=(16, 16), pitch=0.01, planes=16, depth=None):
    """(k, rows, cols) f4 in 0..1, steps of 1 / planes: imprints of the sensor of quasi-tangent planes (T4.2.3.1).

    The first plane holds the three neighbours closest to the vertex (T figure 4.2, `quasi_tangent`), the others follow
    inwards at equal steps down to `depth`, the deepest that the sensor feels. A cell's pressure is the share of planes
    that have met the object there; the image is 1 less it, so that as in `press` 0 is where the object presses most. A
    plane that has left the object again counts on: the thesis registers areas of intersection and does not say, but a
    skin does not pass through a wall, and counted by material a thin cup would show its thickness and not its shape.
    Array, axes and errors as in `distances`; depth by default a quarter of the array's longer side. A plane that just
    touches the surface has met it. Raises ValueError for less than one plane, no depth, and as `quasi_tangent` does.
    """
    surface = ready(mesh)
    cells, pitch, side = check_sensor(cells, pitch)
    if not planes >= 1 or planes % 1:
        raise ValueError(f"planes must be a whole number from 1, got {planes}")
    depth = DEPTH * side if depth is None else depth
    if not (np.isfinite(depth) and depth > 0):
        raise ValueError(f"depth must be a positive number of units, got {depth}")
    centres, axes = quasi_tangent(surface.mesh, vertices)
    found = distances_at(surface, centres, axes, cells, pitch, reach=2 * depth) - LIFT * surface.mesh.diagonal
    short = np.searchsorted(np.linspace(0, depth, int(planes)), found)  # planes that end above the surface
    return (short / planes).astype(np.float32)


def quasi_tangent(mesh, vertices):
    """(centres (k, 3), axes (k, 3, 3)) of arrays on the planes through the three neighbours closest to each vertex.

    The plane's normal is the cross product of P1P2 and P1P3, turned to the side of the average normal; the array's
    centre is the vertex's place on the plane. Neighbours are vertices one edge away. Where the three lie in one line
    the next closest stands in for the third, at last one two edges away; coincident vertices count as one.
    Raises ValueError naming the vertex around which no three neighbours span a plane, or that has no normal.
    """
    vertices = check_vertices(mesh, vertices)
    outward = sensor_normals(mesh, vertices)
    found = [_plane(mesh, vertex) for vertex in vertices]
    places, normals = (np.array(part).reshape(-1, 3) for part in ([one[0] for one in found], [one[1] for one in found]))
    normals *= np.where(np.einsum("ij,ij->i", normals, outward) < 0, -1, 1)[:, None]
    points = mesh.vertices[vertices]
    centres = points + np.einsum("ij,ij->i", places - points, normals)[:, None] * normals
    return centres, sensor_axes(normals)


def _plane(mesh, vertex):
    """(a point (3,), unit normal (3,)) of the plane through the three closest neighbours that span one."""
    links, point = mesh.adjacency, mesh.vertices[vertex]
    near = links.indices[links.indptr[vertex] : links.indptr[vertex + 1]]
    for ids in (near, np.unique(links[near].indices)):
        others = mesh.vertices[ids] - point
        far = np.linalg.norm(others, axis=1)
        others = np.unique(np.c_[far, others][far > 0], axis=0)[:, 1:]  # closest first, each place once
        if len(others) < 3:
            continue
        crosses = np.cross(others[1] - others[0], others[2:] - others[0])
        sides = np.linalg.norm(others[1] - others[0]) * np.linalg.norm(others[2:] - others[0], axis=1)
        spans = np.flatnonzero(np.linalg.norm(crosses, axis=1) > IN_LINE * sides)
        if len(spans):
            return point + others[0], unit(crosses[spans[0]])
    raise ValueError(
        f"around vertex {vertex} no three neighbours span a plane: they are fewer, or in one line; `press` needs none"
    )
