"""Colours and texture coordinates of a surface transferred to a coarser one of the same shape.

Each comes from the closest point of the original surface. Texture coordinates are transferred chart by chart: a chart
is a patch of faces whose coordinates are continuous across the edges between them, a seam is where they are not. A face
of the coarse mesh takes the chart under its centre, so that no face shows the stretch of image between two charts.
"""

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from haptic_glance.mesh.mesh import Mesh, Texture, edge_pairs
from haptic_glance.mesh.nearest import SurfaceIndex
from haptic_glance.mesh.rays import barycentric

SAME = 1e-6  # texture coordinates this close are continuous across an edge; an image has some 1e3 pixels per side
INWARDS = 1e-3  # of the way to the face's centre: a corner on a seam then lies on its own side of it
BEYOND = 1.0  # barycentric: how far past the closest face its coordinates are extrapolated
FAR = 50.0  # the same from the face under the centre to the corners, some tens of the original's faces away


def carry(reference: Mesh, mesh: Mesh) -> Mesh:
    """`mesh` with the colours and the texture of `reference`, the Mesh from which it was simplified.

    Colours (n, 3) are interpolated at the closest point of the reference's surface; a vertex at the position of one of
    the reference's takes its colour unchanged. Texture coordinates (m, 3, 2) are those of the chart under the face's
    centre, at the closest point of each corner within the chart, extrapolated affinely where the corner lies past the
    seam. The images stay unchanged. Colours that `mesh` has already stay, as those of a simplification whose error
    counts them. Where the reference has neither, the mesh itself is returned.

    Source: attributes at the closest point as in Cohen, Olano and Manocha 1998 (appearance-preserving simplification,
    section 3); the thesis has no attributes. Raises ValueError where the reference has no faces.
    """
    if len(reference.faces) == 0:
        raise ValueError("the reference has no faces to take attributes from")
    if mesh is reference or len(mesh.faces) == 0 or (reference.colors is None and reference.texture is None):
        return mesh
    colors = mesh.colors
    if colors is None and reference.colors is not None:
        colors = carry_colors(reference, mesh.vertices)
    texture = None if reference.texture is None else carry_texture(reference, mesh)
    return Mesh(mesh.vertices, mesh.faces, colors, texture, reference.up)


def carry_colors(reference: Mesh, points: np.ndarray) -> np.ndarray:
    """(k, 3) u1: the reference's vertex colours at the closest points of its surface to points (k, 3)."""
    face, weights = closest(reference, points)
    assert reference.colors is not None
    colors = np.einsum("ij,ijk->ik", weights, reference.colors[reference.faces[face]].astype(np.float64))
    vertex_ids = np.unique(reference.faces)
    ids = np.unique(np.concatenate([reference.vertices[vertex_ids], points]), axis=0, return_inverse=True)[1].ravel()
    owner = np.full(ids.max() + 1, -1)
    owner[ids[: len(vertex_ids)]] = vertex_ids
    vertex = owner[ids[len(vertex_ids) :]]
    colors[vertex >= 0] = reference.colors[vertex[vertex >= 0]]
    return np.rint(colors).astype(np.uint8)


def closest(mesh: Mesh, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(faces (k,), barycentric weights (k, 3)): the closest points on a mesh to points (k, 3)."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    index = SurfaceIndex(mesh)
    face = index.nearest(points)[1].astype(np.int64)
    return face, index.weights(points, face)


def carry_texture(reference: Mesh, mesh: Mesh) -> Texture:
    """The Texture of the faces of `mesh`, taken from the reference's."""
    assert reference.texture is not None
    chart, jump = charts(reference)
    corners = mesh.vertices[mesh.faces]
    centres = corners.mean(axis=1)
    index = SurfaceIndex(reference)
    closest_faces = index.nearest(centres)[1]
    inside = corners + INWARDS * (centres[:, None] - corners)
    nearest = np.repeat(closest_faces, 3).reshape(-1, 3)  # in charts of one face; in the others it is searched for
    sources = _by_value(chart)
    for number, faces in _by_value(chart[closest_faces]).items():
        if len(sources[number]) > 1:
            vertex_ids, ids = np.unique(reference.faces[sources[number]], return_inverse=True)
            part = SurfaceIndex(Mesh(reference.vertices[vertex_ids], ids.reshape(-1, 3)))
            nearest[faces] = sources[number][part.nearest(inside[faces].reshape(-1, 3))[1]].reshape(-1, 3)
    nearest, corner_points = nearest.ravel(), corners.reshape(-1, 3)
    weights = index.weights(inside.reshape(-1, 3), nearest)
    uv = _extrapolated(reference, nearest, weights, corner_points, BEYOND).reshape(*mesh.faces.shape, 2)
    # A corner across a seam between two ends of one chart (the back of a cylinder) got the coordinates of the other
    # end.
    at_centre = np.repeat(index.weights(centres, closest_faces), 3, axis=0)
    ahead = _extrapolated(reference, np.repeat(closest_faces, 3), at_centre, corner_points, FAR).reshape(uv.shape)
    astray = np.linalg.norm(uv - ahead, axis=2) > jump[chart[closest_faces]][:, None] / 2
    uv[astray] = ahead[astray]
    return replace(reference.texture, uv=uv, image=reference.texture.image[closest_faces])


def charts(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """(chart (m,) of each face, jump (charts,)); a corner farther off than half the jump has crossed a seam.

    jump is the median length, in texture coordinates, of the jumps across the seams with the chart on both sides;
    infinite where it has none.
    """
    assert mesh.texture is not None
    uv, image = mesh.texture.uv, mesh.texture.image
    first, second, length = _shared_edges(mesh)
    continuous = (length <= SAME) & (image[first] == image[second])
    graph = sparse.coo_matrix(
        (np.ones(continuous.sum()), (first[continuous], second[continuous])), shape=(len(uv), len(uv))
    )
    count, chart = connected_components(graph, directed=False)
    jump = np.full(count, np.inf)
    seam = ~continuous & (chart[first] == chart[second])
    lengths = length[seam]
    for number, edges in _by_value(chart[first[seam]]).items():
        jump[number] = np.median(lengths[edges])
    return chart, jump


def _by_value(numbers):
    """{number: the places (k,) where it stands, in order} of numbers (n,), in one pass."""
    order = np.argsort(numbers, kind="stable")
    values, starts = np.unique(numbers[order], return_index=True)
    return dict(zip(values.tolist(), np.split(order, starts)[1:], strict=True))


def _shared_edges(mesh):
    """(first face (e,), second face (e,), length (e,) of the larger jump at the two ends) of the edges of two faces."""
    tails, heads = mesh.faces.ravel(), np.roll(mesh.faces, -1, axis=1).ravel()
    at_tail, at_head = mesh.texture.uv.reshape(-1, 2), np.roll(mesh.texture.uv, -1, axis=1).reshape(-1, 2)
    is_reversed = (tails > heads)[:, None]
    low, high = np.where(is_reversed, at_head, at_tail), np.where(is_reversed, at_tail, at_head)
    first, second = edge_pairs(mesh.faces, len(mesh.vertices))
    jumps = [np.linalg.norm(ends[first] - ends[second], axis=1) for ends in (low, high)]
    return first // 3, second // 3, np.maximum(*jumps)


def _extrapolated(mesh, faces, weights, points, beyond):
    """(k, 2) texture coordinates at barycentric weights (k, 3) of faces (k,), extrapolated affinely to points (k, 3).

    By at most `beyond` barycentric units, since slivers would extrapolate them anywhere.
    """
    with np.errstate(all="ignore"):
        step = np.nan_to_num(barycentric(mesh, faces, points) - weights)
    step *= np.minimum(beyond / np.maximum(np.abs(step).max(axis=1, keepdims=True), beyond), 1)
    return np.einsum("ij,ijk->ik", weights + step, mesh.texture.uv[faces])
